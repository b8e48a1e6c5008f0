# SPDX-License-Identifier: Apache-2.0
"""The examples of docs/python.md run, and all of the package has types and docstrings."""

import ast
import glob
import inspect
import io
import os
import re
import typing
import unittest
import warnings
from contextlib import redirect_stdout

import orrery
from orrery._arguments import Texture
from support import ROOT, FolderTest


class Examples(FolderTest):
    def test_docs(self):
        with open(os.path.join(ROOT, "docs/python.md"), encoding="utf-8") as file:
            page = file.read()
        examples = list(re.finditer(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL))
        self.assertGreater(len(examples), 8)
        names, out = {}, io.StringIO()
        with warnings.catch_warnings(), redirect_stdout(out):
            warnings.simplefilter("error")
            for example in examples:
                line = page.count("\n", 0, example.start())  # so that a traceback shows the line of the page
                exec(compile("\n" * (line + 1) + example[1], "docs/python.md", "exec"), names)
        for text in ("did you mean `vfov`", "Points(2000 rows: x, y, z)", "float32", "100%", "('Z', 'N')"):
            self.assertIn(text, out.getvalue())
        for name in ("out.exr", "out.png", "saved.toml", "saved.positions-1.ply", "layers.exr", "wave.gif", "turn.mp4"):
            self.assertTrue(os.path.exists(name), name)


class Tests(unittest.TestCase):
    def test_no_test_replaces_another_of_the_same_name(self):
        for file in glob.glob(os.path.join(ROOT, "tests/python/test_*.py")):
            with open(file, encoding="utf-8") as text:
                module = ast.parse(text.read())
            for parent in [module, *(node for node in module.body if isinstance(node, ast.ClassDef))]:
                names = [node.name for node in parent.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))]
                self.assertEqual(len(names), len(set(names)), f"{file}: {names}")


class Annotations(unittest.TestCase):
    """Type checkers and editors read them; the package has no stub file."""

    @staticmethod
    def functions():
        """The public functions and methods, by name."""
        for name in orrery.__all__:
            value = getattr(orrery, name)
            if inspect.isfunction(value):
                yield name, value
            if not inspect.isclass(value) or issubclass(value, (tuple, BaseException)):
                continue
            for member, found in vars(value).items():
                found = found.fget if isinstance(found, property) else getattr(found, "__func__", found)
                is_public = not member.startswith("_") or member in ("__init__", "__getitem__", "__contains__")
                if is_public and inspect.isfunction(found):
                    yield f"{name}.{member}", found

    def test_all_public_functions_have_them(self):
        functions = dict(self.functions())
        self.assertGreater(len(functions), 35)
        for name, function in functions.items():
            types = typing.get_type_hints(function)  # which fails for a type that does not exist
            expected = set(inspect.signature(function).parameters) - {"self", "cls"} | {"return"}
            self.assertEqual(set(types), expected, name)

    def test_textures(self):
        for name in ("Lambertian", "Hemisphere", "Metal", "Dielectric", "Emitter", "Plastic"):
            types = typing.get_type_hints(getattr(orrery, name).__init__)
            found = {a: t for a, t in types.items() if a in ("albedo", "fuzz", "radiance")}
            self.assertTrue(found, name)
            for argument, type_of in found.items():
                self.assertIn(typing.get_args(Texture | None)[0], typing.get_args(type_of), f"{name}: {argument}")


class Docstrings(unittest.TestCase):
    def test_docstrings(self):
        for name in orrery.__all__:
            value = getattr(orrery, name)
            if not callable(value):
                continue
            self.assertTrue(value.__doc__, name)
            for member, found in vars(value).items() if inspect.isclass(value) else ():
                if not member.startswith("_") and (inspect.isfunction(found) or isinstance(found, property)):
                    self.assertTrue(found.__doc__, f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
