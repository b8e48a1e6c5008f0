#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the notebooks of examples/notebooks and stores what they print and show, for pages that only display them.

    PYTHONPATH=build/lib/python3/dist-packages tools/notebooks.py

A film is shown by a frame, and the interactive view not at all. Needs ffmpeg and oiiotool.
"""

import ast
import base64
import contextlib
import io
import json
import os
import pathlib
import shutil
import subprocess
import tempfile

import orrery

EXAMPLES = pathlib.Path(__file__).resolve().parents[1] / "examples"


def jpeg(value):
    """The image that stands for a value, or None."""
    if isinstance(value, orrery.Movie):
        subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", value.file, "-vf", "thumbnail=100", "-frames:v", "1", "shown.png"], check=True)
    elif isinstance(value, orrery.Picture):
        value.write("shown.png")
    else:
        return None
    subprocess.run(["oiiotool", "--nosoftwareattrib", "shown.png", "--ch", "R,G,B", "--eraseattrib", ".*", "--compression", "jpeg:80",
                    "-o", "shown.jpg"], check=True)  # fmt: skip
    return base64.b64encode(pathlib.Path("shown.jpg").read_bytes()).decode()


def lines(text):
    return text.splitlines(keepends=True)


def run(notebook):
    """Runs the code cells, and replaces their outputs."""
    names = {}
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    for count, cell in enumerate(cells, 1):
        module = ast.parse("".join(cell["source"]))
        last = module.body.pop() if isinstance(module.body[-1], ast.Expr) else None
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(module, "cell", "exec"), names)
            value = None if last is None else eval(compile(ast.Expression(last.value), "cell", "eval"), names)
        cell["execution_count"] = count
        cell["outputs"] = []
        if printed.getvalue():
            cell["outputs"].append({"name": "stdout", "output_type": "stream", "text": lines(printed.getvalue())})
        image = jpeg(value)
        if image is not None:
            cell["outputs"].append({"data": {"image/jpeg": image, "text/plain": lines(repr(value))}, "execution_count": count,
                                    "metadata": {}, "output_type": "execute_result"})  # fmt: skip


with tempfile.TemporaryDirectory() as work:
    for folder in ("protein", "lammps-film"):
        shutil.copytree(EXAMPLES / folder, pathlib.Path(work, folder))
    os.mkdir(os.path.join(work, "notebooks"))
    os.chdir(os.path.join(work, "notebooks"))
    for file in sorted((EXAMPLES / "notebooks").glob("*.ipynb")):
        notebook = json.loads(file.read_text(encoding="utf-8"))
        run(notebook)
        file.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
