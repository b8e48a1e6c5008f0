#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints figures of the structure of src/: lines, rooms, small headers, and headers that only one file includes. Lines of
code are neither blank, nor comments or docstrings, nor includes, `#pragma once` or imports.

    tools/structure.py              the figures of the whole
    tools/structure.py --rooms      a row for each room as well
    tools/structure.py --headers    the headers that are counted as small or as included once as well
    tools/structure.py --program build/src/orrery   the number of options of `orrery render` as well
"""
import argparse
import collections
import pathlib
import re
import subprocess

SMALL = 30  # lines

arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
arguments.add_argument("--rooms", action="store_true")
arguments.add_argument("--headers", action="store_true")
arguments.add_argument("--program")
options = arguments.parse_args()

src = pathlib.Path(__file__).resolve().parent.parent / "src"
files = {file: file.read_text(encoding="utf-8").splitlines()
         for file in sorted(src.rglob("*")) if file.suffix in (".h", ".cpp", ".py")}
headers = {str(file.relative_to(src)): lines for file, lines in files.items() if file.suffix == ".h"}
includers = collections.defaultdict(set)
for file, lines in files.items():
    for line in lines:
        if found := re.match(r'\s*#\s*include\s+"([^"]+)"', line):
            includers[found[1]].add(file)

PYTHON_TEXT = re.compile(r'^\s*r?"""(?:.|\n)*?"""\s*$', re.MULTILINE)  # a docstring


def code_lines(file, lines):
    """The number of lines of code of a file."""
    if file.suffix == ".py":
        rest = PYTHON_TEXT.sub("", "\n".join(lines)).splitlines()
        return sum(not re.match(r"\s*(#.*|import .*|from \S+ import .*)?$", line) for line in rest)
    return sum(not re.match(r"\s*(//.*|#\s*(include\b|pragma once).*)?$", line) for line in lines)


small = [name for name, lines in headers.items() if len(lines) < SMALL]
# A source file and the header of its name are one unit.
once = [name for name in headers
        if len([file for file in includers[name] if file.relative_to(src).with_suffix("") != pathlib.Path(name).with_suffix("")]) == 1]
rooms, code = collections.Counter(), collections.Counter()
for file, lines in files.items():
    rooms[file.relative_to(src).parts[0]] += len(lines)
    code[file.relative_to(src).parts[0]] += code_lines(file, lines)

if options.rooms:
    for room, count in rooms.items():
        print(f"{room:12} {count:6} lines, {code[room]:6} of code, {sum(file.relative_to(src).parts[0] == room for file in files):3} files")
print(f"lines of src (.h, .cpp, .py)          {sum(rooms.values())}")
print(f"lines of code                         {sum(code.values())}")
print(f"rooms                                 {len(rooms)}")
print(f"headers                               {len(headers)}")
print(f"headers under {SMALL} lines              {len(small)}")
print(f"headers with one includer             {len(once)}")
if options.program:
    text = subprocess.run([options.program, "render", "--help"], check=True, capture_output=True, text=True).stdout
    print(f"options of orrery render              {len(re.findall(r'^ +(?:-[a-zA-Z], ?)?--[a-z]', text, re.MULTILINE))}")
if options.headers:
    for title, names in (("small", small), ("once", once)):
        for name in names:
            print(f"{title}  {name}")
