#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the cost of layers: paths per second relative to the beauty alone, in alternating runs on one thread.

    bench/layers.py build/src/orrery
    bench/layers.py build/src/orrery --before ../older/build/src/orrery

The second form also compares the beauty alone with that of another build.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

SCENE = pathlib.Path(__file__).resolve().parent.parent / "scenes" / "book" / "final.toml"
EVERY = ("Z,depth,N,P,albedo,diffuse,specular,transmission,background,variance,samples,object_id,material_id,"
         "denoise.albedo,denoise.normal,CryptoObject,CryptoMaterial")


def paths_per_second(program, precision, layers, folder):
    arguments = ["-q", "-t", "1", "--precision", precision, "--samples", "32", "--width", "480", "--height", "270"]
    if layers:
        arguments += ["--layers", layers]
    report = folder / "stats.json"
    subprocess.run([program, "render", SCENE, "-o", folder / "picture.exr", "--stats", report, *arguments], check=True)
    return json.loads(report.read_text())["paths_per_second"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("orrery", help="the orrery executable")
    parser.add_argument("--before", help="executable of another build whose beauty is measured in the same run")
    parser.add_argument("--rounds", type=int, default=7, help="measurements of each case")
    arguments = parser.parse_args()
    cases = {"beauty": (arguments.orrery, ""), "Z": (arguments.orrery, "Z"),
             "light": (arguments.orrery, "diffuse,specular,transmission,background"),
             "mattes": (arguments.orrery, "CryptoObject,CryptoMaterial"), "every layer": (arguments.orrery, EVERY)}
    if arguments.before:
        cases["beauty before"] = (arguments.before, "")
    with tempfile.TemporaryDirectory() as name:
        for precision in ("exact", "fast"):
            seen = {case: [] for case in cases}
            for _ in range(arguments.rounds):
                for case, (program, layers) in cases.items():
                    seen[case].append(paths_per_second(program, precision, layers, pathlib.Path(name)))
            for case, speeds in seen.items():
                ratios = [a / b for a, b in zip(speeds, seen["beauty"])]
                print(f"{precision:6} {case:14} {statistics.median(speeds) / 1e6:6.2f} M paths/s, "
                      f"{statistics.median(ratios):.2f} ({min(ratios):.2f} .. {max(ratios):.2f}) times the beauty alone")


if __name__ == "__main__":
    main()
