# SPDX-License-Identifier: Apache-2.0
"""The notebooks of examples/notebooks run. A cell runs as in Jupyter: the value of its last line is shown."""

import ast
import glob
import json
import os
import shutil
import unittest
from unittest import mock

import orrery
from support import ROOT, FolderTest

NOTEBOOKS = sorted(glob.glob(os.path.join(ROOT, "examples/notebooks/*.ipynb")))


def small(function):
    """The function with an image of 64 x 36 pixels and two samples each."""

    def smaller(*arguments, **options):
        options.pop("quality", None)
        if function.__qualname__.startswith("Scene."):
            arguments = arguments[:1]  # width and height follow the scene
        return function(*arguments, **{**options, "width": 64, "height": 36, "samples": 2})

    return smaller


def shown(value):
    """Makes the forms of a value that Jupyter shows, of which it takes the best."""
    for form in ("_repr_html_", "_repr_png_"):
        make = getattr(value, form, None)
        if make is not None:
            return make()
    return repr(value)


def run_cells(file):
    """Runs the code cells of a notebook. Returns what the last lines of the cells show."""
    with open(file, encoding="utf-8") as text:
        cells = json.load(text)["cells"]
    names, out = {}, []
    for index, cell in enumerate(cell for cell in cells if cell["cell_type"] == "code"):
        module = ast.parse("".join(cell["source"]), f"{file}, cell {index}")
        last = module.body.pop() if isinstance(module.body[-1], ast.Expr) else None
        exec(compile(module, f"{file}, cell {index}", "exec"), names)
        value = None if last is None else eval(compile(ast.Expression(last.value), f"{file}, cell {index}", "eval"), names)
        has_image = any("image/jpeg" in output.get("data", {}) for output in cell["outputs"])
        if has_image != isinstance(value, (orrery.Picture, orrery.Movie)):
            raise ValueError(f"{file}, cell {index}: the stored image is missing or superfluous; run tools/notebooks.py")
        if value is not None:
            out.append(shown(value))
    return out


class Notebooks(FolderTest):
    def setUp(self):
        super().setUp()
        for folder in ("protein", "lammps-film"):
            shutil.copytree(os.path.join(ROOT, "examples", folder), folder)
        os.mkdir("notebooks")
        os.chdir("notebooks")

    def run_notebook(self, name):
        functions = ((orrery, "plot"), (orrery, "movie"), (orrery.Scene, "render"), (orrery.Scene, "view"))
        patches = [mock.patch.object(owner, function, small(getattr(owner, function))) for owner, function in functions]
        for patch in patches:
            patch.start()
            self.addCleanup(patch.stop)
        return run_cells(os.path.join(ROOT, f"examples/notebooks/{name}.ipynb"))

    def test_all_are_run(self):
        self.assertEqual([os.path.basename(file) for file in NOTEBOOKS], ["figure.ipynb", "film.ipynb", "view.ipynb"])

    def test_figure(self):
        images = self.run_notebook("figure")
        self.assertEqual(len(set(images)), 3)
        self.assertTrue(all(image.startswith(b"\x89PNG") for image in images))
        self.assertTrue(os.path.exists("capsomer.exr"))

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
    def test_film(self):
        films = self.run_notebook("film")
        self.assertEqual([film.split(" ")[0] for film in films], ["<video", "<img", "<video"])

    def test_view(self):
        page, image = self.run_notebook("view")
        self.assertIn("<iframe", page)
        self.assertTrue(image.startswith(b"\x89PNG"))


if __name__ == "__main__":
    unittest.main()
