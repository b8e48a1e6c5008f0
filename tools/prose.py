#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Counts the assertions of the C++ tests on exact prose: those with a string of six words in a row, without a
comma or a number between them. A wording
that changes should change few tests; the others check the status, and the place, names and numbers of a message.

    tools/prose.py          the number in each file, and the sum
    tools/prose.py --list   each of them
"""
import pathlib
import re
import subprocess
import sys

STRING = re.compile(r'"((?:[^"\\]|\\.)*)"')
PROSE = re.compile(r"(?:\b(?:a|[A-Za-z][a-z'-]+)[;:]? ){5}[a-z]+")

root = pathlib.Path(__file__).resolve().parent.parent
total = 0
for name in subprocess.run(["git", "ls-files", "tests/*.cpp", "tests/*.h"], cwd=root, capture_output=True, text=True,
                           check=True).stdout.split():
    text = re.sub(r'"\s*\n\s*"', "", (root / name).read_text(encoding="utf-8"))  # adjacent strings are one
    found = []
    for start in re.finditer(r"\b(?:EXPECT|ASSERT)_\w+\(|\bexpect_\w+\(", text):
        at, depth = start.end(), 1
        while depth > 0 and at < len(text):
            string = STRING.match(text, at)
            depth += 0 if string else (text[at] == "(") - (text[at] == ")")
            at = string.end() if string else at + 1
        strings = [string for string in STRING.findall(text[start.start():at]) if PROSE.search(string)]
        if strings:
            found.append((text.count("\n", 0, start.start()) + 1, strings))
    total += len(found)
    if found and "--list" not in sys.argv:
        print(f"{len(found):4} {name}")
    for line, strings in found if "--list" in sys.argv else []:
        print(f"{name}: {strings}")
print(f"{total:4} assertions on exact prose")
