#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the mutants of table.txt whose text does not occur exactly once in their file. Exit status 1 if there are any.

    tools/mutants/stale.py [NAME...]     only these; default: all
"""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
names = set(sys.argv[1:])
stale = 0
for line in (ROOT / "tools/mutants/table.txt").read_text().splitlines():
    if line.startswith("@ "):
        _, name, file = line.split()
    elif line.startswith("< ") and (not names or name in names):
        path = ROOT / file
        count = path.read_text().count(line[2:]) if path.is_file() else 0
        if count != 1:
            print(f"tools/mutants/table.txt: {name}: its text occurs {count} times in {file}", file=sys.stderr)
            stale += 1
sys.exit(1 if stale else 0)
