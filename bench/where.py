#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints where the time of a render goes: nanoseconds of processor time per path, by the function in which perf's samples
were taken. One thread, at the settings of bench/peers/ospray.py.

    bench/where.py build/src/orrery
    bench/where.py build/src/orrery --scene cloud.toml --samples 32

Needs Linux's perf, which may use the clock of the processor (sysctl kernel.perf_event_paranoid=2 or less).
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

SCENE = pathlib.Path(__file__).resolve().parent.parent / "scenes" / "book" / "final.toml"
SETTINGS = ["--width", "480", "--height", "270", "-t", "1", "--quiet", "--set", 'render.sampler="independent"', "--set",
            "render.roulette_depth=0", "--set", "render.max_depth=50"]
RATE_HZ = 997
# The first pattern that a line of library and symbol matches has its samples.
ROWS = [
    ("Embree's traversal", r"^libembree"),
    ("Embree's callback: one sphere against the rays of a packet", r"accel::N_.*\bat_(sphere|rod)<"),
    ("the BVH of many spheres", r"accel::N_.*(trace_by_rays|trace_rays|at_bvh|PacketTraversal|SingleRay)"),
    ("rays for Embree, and outliers", r"accel::N_"),
    ("camera rays, hit points, materials, scattering, sums of pixels", r"kernel::N_"),
    ("the rest: start of the program, page faults, files, build", r""),
]


def nanoseconds(program, scene, samples, precision, folder):
    """Nanoseconds per path for each row."""
    stats, data = folder / "stats.json", folder / "perf.data"
    render = [program, "render", scene, "-o", folder / "image.exr", "--samples", str(samples), "--precision", precision,
              "--stats", stats, *SETTINGS]
    subprocess.run(["perf", "record", "-q", "-e", "cpu-clock", "-F", str(RATE_HZ), "-o", data, *render], check=True)
    report = subprocess.run(["perf", "report", "-i", data, "--no-children", "--sort", "dso,symbol", "-F",
                             "sample,dso,symbol", "--field-separator", "|"], check=True, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout
    paths = json.loads(stats.read_text())["paths"]
    found = dict.fromkeys((name for name, _ in ROWS), 0.0)
    for line in report.splitlines():
        count, _, place = line.partition("|")
        if not count.strip().isdigit():
            continue
        place = " ".join(place.split())
        row = next(name for name, pattern in ROWS if re.search(pattern, place))
        found[row] += int(count) / RATE_HZ * 1e9 / paths
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("orrery", help="the orrery executable")
    parser.add_argument("--scene", default=SCENE, help="a scene file; default: the book's final scene")
    parser.add_argument("--samples", type=int, default=300, help="per pixel")
    arguments = parser.parse_args()
    precisions = ("exact", "fast")
    with tempfile.TemporaryDirectory() as name:
        seen = [nanoseconds(arguments.orrery, arguments.scene, arguments.samples, precision, pathlib.Path(name))
                for precision in precisions]
    print("| ns per path | " + " | ".join(f"`{precision}`" for precision in precisions) + " |\n|---|---|---|")
    for row, _ in ROWS:
        print(f"| {row} | " + " | ".join(f"{one[row]:.1f}" for one in seen) + " |")
    print("| **in all** | " + " | ".join(f"{sum(one.values()):.1f}" for one in seen) + " |")


if __name__ == "__main__":
    sys.exit(main())
