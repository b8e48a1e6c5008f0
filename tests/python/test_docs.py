# SPDX-License-Identifier: Apache-2.0
"""The examples of docs/python.md run, and the stub file agrees with the package."""

import ast
import glob
import inspect
import io
import os
import re
import unittest
import warnings
from contextlib import redirect_stdout

import orrery
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
        for name in ("out.exr", "out.png", "saved.toml", "saved.positions-1.ply", "layers.exr"):
            self.assertTrue(os.path.exists(name), name)


def parameters_of(function):
    """Names, kinds and defaults of a function of the stub file, as inspect.signature gives them."""
    a, kind = function.args, inspect.Parameter
    positional = [*a.posonlyargs, *a.args]
    defaults = [None] * (len(positional) - len(a.defaults)) + a.defaults
    out = [(p.arg, kind.POSITIONAL_OR_KEYWORD, d) for p, d in zip(positional, defaults)]
    if a.vararg:
        out.append((a.vararg.arg, kind.VAR_POSITIONAL, None))
    out += [(p.arg, kind.KEYWORD_ONLY, d) for p, d in zip(a.kwonlyargs, a.kw_defaults)]
    if a.kwarg:
        out.append((a.kwarg.arg, kind.VAR_KEYWORD, None))
    return [(n, k, kind.empty if d is None else ast.literal_eval(d)) for n, k, d in out]


class Tests(unittest.TestCase):
    def test_no_test_replaces_another_of_the_same_name(self):
        for file in glob.glob(os.path.join(ROOT, "tests/python/test_*.py")):
            with open(file, encoding="utf-8") as text:
                module = ast.parse(text.read())
            for parent in [module, *(node for node in module.body if isinstance(node, ast.ClassDef))]:
                names = [node.name for node in parent.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))]
                self.assertEqual(len(names), len(set(names)), f"{file}: {names}")


class Stub(unittest.TestCase):
    def setUp(self):
        stub = os.path.join(os.path.dirname(orrery.__file__), "__init__.pyi")
        with open(stub, encoding="utf-8") as file:
            self.nodes = {self.name(node): node for node in ast.parse(file.read()).body if self.name(node)}

    @staticmethod
    def name(node):
        if isinstance(node, ast.AnnAssign):
            return node.target.id
        return getattr(node, "name", None)

    def expect_same_signature(self, function, node, where):
        found = [(p.name, p.kind, p.default) for p in inspect.signature(function).parameters.values()]
        self.assertEqual(found, parameters_of(node), where)

    def test_names(self):
        public = {name for name in self.nodes if not name.startswith("_")}
        self.assertEqual(public, set(orrery.__all__))

    def test_signatures(self):
        compared = 0
        for name in orrery.__all__:
            value, node = getattr(orrery, name), self.nodes[name]
            if inspect.isfunction(value):
                self.expect_same_signature(value, node, name)
                compared += 1
            if not inspect.isclass(value):
                continue
            members = {m.name: m for m in node.body if isinstance(m, ast.FunctionDef)}
            own = {m for m in vars(value) if inspect.isroutine(getattr(value, m)) or isinstance(vars(value)[m], property)}
            hidden = {m for m in own if m.startswith("_") and m not in ("__init__", "__getitem__", "__contains__")}
            if not issubclass(value, (tuple, BaseException)):
                self.assertEqual(own - hidden - set(members), set(), f"{name}: missing in the stub file")
            for member, definition in members.items():
                found = inspect.getattr_static(value, member)
                if isinstance(found, property):
                    self.assertEqual(ast.unparse(definition.decorator_list[0]), "property", member)
                    continue
                if isinstance(found, classmethod):
                    found = found.__func__
                self.expect_same_signature(found, definition, f"{name}.{member}")
                compared += 1
        self.assertGreater(compared, 25)

    def test_textures(self):
        for name in ("Lambertian", "Hemisphere", "Metal", "Dielectric", "Emitter"):
            init = next(node for node in self.nodes[name].body if node.name == "__init__")
            arguments = [*init.args.args, *init.args.kwonlyargs]
            found = {a.arg: ast.unparse(a.annotation) for a in arguments if a.arg in ("albedo", "fuzz", "radiance")}
            self.assertTrue(found, name)
            for argument, types in found.items():
                self.assertIn("_Texture", types, f"{name}: {argument}")

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
