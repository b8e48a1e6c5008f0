#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the error of orrery and Cycles in scenes with lights, in the same rendering time on one thread.

    apt-get install blender
    bench/peers/lit.py build/src/orrery [--size 320x180] [--seconds 15] [--seeds 3]

The time of a sample is measured first, as the difference of two renders, so that start-up and building do not count.
Every renderer then gets as many samples as fit into --seconds. The error is the display error of `orrery compare`
against a reference of the same renderer with 16 times the samples, since the renderers' metals differ; the means of the
references are printed to show that they render the same scene.
"""
import argparse
import json
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import lights  # noqa: E402
from run import run, seconds_in  # noqa: E402

REFERENCE = 16  # samples of a reference relative to those that are measured


class Orrery:
    def __init__(self, program, precision, options):
        self.program, self.precision = program, precision
        self.size = options.size.split("x")

    def render(self, scene, samples, seed, out):
        """Returns seconds."""
        stats = out.with_suffix(".json")
        run(self.program, "render", str(scene), "-o", str(out), "--type", "float", "-t", "1", "-q", "--stats", str(stats),
            "--width", self.size[0], "--height", self.size[1], "--samples", str(samples), "--set", f"render.seed={seed}",
            "--precision", self.precision, "--layers", "")
        return json.loads(stats.read_text())["seconds"]["render"]


class Cycles:
    def __init__(self, options):
        self.size = options.size

    def render(self, scene, samples, seed, out):
        """Returns seconds, including start-up."""
        output = run("blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python",
                     str(HERE / "cycles.py"), "--", str(scene), self.size, str(samples), "1", str(out), str(seed))
        return seconds_in(output, r"seconds ([0-9.]+)")


def mean(file):
    text = run("oiiotool", "--stats", str(file))
    line = next(line for line in text.splitlines() if "Stats Avg" in line)
    return statistics.fmean(float(word) for word in line.split(":")[1].split()[:3])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("orrery", metavar="ORRERY", help="the orrery executable")
    parser.add_argument("--size", default="320x180", metavar="WxH", help="image size, px")
    parser.add_argument("--seconds", type=float, default=15, help="rendering time of each image")
    parser.add_argument("--seeds", type=int, default=3)
    options = parser.parse_args()
    if not shutil.which("blender"):
        sys.exit("lit.py: error: blender is not installed")
    renderers = {"orrery exact": Orrery(options.orrery, "exact", options),
                 "orrery fast": Orrery(options.orrery, "fast", options), "Cycles": Cycles(options)}
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        (work / "penumbra.toml").write_text(lights.PENUMBRA)
        scenes = {"penumbra": work / "penumbra.toml", "three-point": lights.ROOT / "scenes/light/three-point.toml"}
        print(f"{options.size}, one thread, {options.seconds:g} s, {options.seeds} seeds\n")
        print(f"{'scene':14}{'renderer':14}{'samples':>9}{'error':>10}{'error / exact':>15}{'mean of reference':>20}")
        for scene_name, scene in scenes.items():
            first = None
            for name, renderer in renderers.items():
                out, reference = work / "out.exr", work / "reference.exr"
                few, more = 8, 72
                per_sample = statistics.median(
                    (renderer.render(scene, more, i, out) - renderer.render(scene, few, i, out)) / (more - few)
                    for i in range(3))
                samples = max(1, round(options.seconds / per_sample))
                renderer.render(scene, REFERENCE * samples, 999, reference)
                squares = []
                for seed in range(options.seeds):
                    renderer.render(scene, samples, seed, out)
                    compared = json.loads(run(options.orrery, "compare", str(out), str(reference), "--json"))
                    squares.append(compared["display"] ** 2)
                error = statistics.fmean(squares) ** 0.5
                first = first or error
                print(f"{scene_name:14}{name:14}{samples:9}{error:10.5f}{error / first:15.2f}{mean(reference):20.5f}",
                      flush=True)


if __name__ == "__main__":
    sys.exit(main())
