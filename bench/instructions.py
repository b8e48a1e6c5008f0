#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Counts the instructions that two builds execute to render a scene, with Valgrind's Callgrind.

    bench/instructions.py ../older/build/src/orrery build/src/orrery [--scene scenes/book/final.toml]

Timing on a noisy machine cannot resolve differences of one percent; an instruction count is the same in every run. It
ignores caches and branch mispredictions, so it shows what a change added, not how fast a program is. Reading the scene
and writing files cancel out: each build renders twice with different sample counts, and the difference is reported.
"""
import argparse
import pathlib
import re
import subprocess
import tempfile

SCENE = pathlib.Path(__file__).resolve().parent.parent / "scenes" / "book" / "final.toml"
FEW, MANY = 16, 48


def packets(program):
    """Options for traversal by packets, which does not depend on time; older versions have another option."""
    text = subprocess.run([program, "render", "--help"], check=True, capture_output=True, text=True).stdout
    return ["--traversal", "packet"] if "--traversal" in text else ["--set", "render.traversal=packet"]


def instructions(program, scene, precision, samples, folder):
    subprocess.run(["valgrind", "--tool=callgrind", "--trace-children=yes",  # the launcher becomes the program
                    f"--callgrind-out-file={folder}/counts", f"--log-file={folder}/log", program, "render",
                    scene, "-q", "-t", "1", *packets(program), "--precision", precision,
                    "--width", "96", "--height", "54", "--samples", str(samples), "-o", f"{folder}/picture.exr"],
                   check=True)
    return int(re.search(r"^(?:totals|summary): (\d+)", pathlib.Path(folder, "counts").read_text(), re.M).group(1))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before", help="the orrery executable of the older build")
    parser.add_argument("after", help="the orrery executable of the newer build")
    parser.add_argument("--scene", default=SCENE, help="the scene file; default: the book's final scene")
    arguments = parser.parse_args()
    paths = 96 * 54 * (MANY - FEW)
    with tempfile.TemporaryDirectory() as folder:
        for precision in ("exact", "fast"):
            before, after = [(instructions(program, arguments.scene, precision, MANY, folder) -
                              instructions(program, arguments.scene, precision, FEW, folder)) / paths
                             for program in (arguments.before, arguments.after)]
            print(f"{precision:6} {before:7.0f} instructions per path before, {after:7.0f} after, "
                  f"ratio {after / before:.3f}")


if __name__ == "__main__":
    main()
