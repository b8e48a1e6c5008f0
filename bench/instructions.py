#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Instructions that rendering the final scene takes in two builds, counted by valgrind.

    bench/instructions.py ../older/build/src/orrery build/src/orrery

A machine whose speed wanders can't tell a percent; a count is the same in every run. It knows nothing of caches and
mispredicted branches, so it is for finding out what a change added, not for saying how fast a program is. Reading and
writing files, which are the same in both, are taken out: two renders that differ in their samples only, and the
difference is counted.
"""
import argparse
import pathlib
import re
import subprocess
import tempfile

SCENE = pathlib.Path(__file__).resolve().parent.parent / "scenes" / "book" / "final.toml"
FEW, MANY = 16, 48


def instructions(program, precision, samples, folder):
    subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/counts", f"--log-file={folder}/log",
                    program, "render", SCENE, "-q", "-t", "1", "--traversal", "packet", "--precision", precision,
                    "--width", "96", "--height", "54", "--samples", str(samples), "-o", f"{folder}/picture.exr"],
                   check=True)
    return int(re.search(r"^(?:totals|summary): (\d+)", pathlib.Path(folder, "counts").read_text(), re.M).group(1))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before")
    parser.add_argument("after")
    arguments = parser.parse_args()
    paths = 96 * 54 * (MANY - FEW)
    with tempfile.TemporaryDirectory() as folder:
        for precision in ("exact", "fast"):
            before, after = [(instructions(program, precision, MANY, folder) -
                              instructions(program, precision, FEW, folder)) / paths
                             for program in (arguments.before, arguments.after)]
            print(f"{precision:6} {before:7.0f} instructions a path before, {after:7.0f} after: {after / before:.3f}")


if __name__ == "__main__":
    main()
