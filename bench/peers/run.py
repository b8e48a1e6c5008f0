#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the speed of orrery with other renderers in Debian: renders one scene on one thread each, in alternating
rounds, and prints paths per second and the ratio to orrery exact. docs/benchmarks.md lists the differences in what the
renderers compute.

    apt-get install povray tachyon blender
    bench/peers/run.py build/src/orrery scenes/book/final.toml [--size 480x270] [--samples 64] [--rounds 5]

Renderers that are not installed are skipped with a message. Times are the rendering times that each program reports;
start-up and parsing do not count.
"""

import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))


class Failed(Exception):
    """A program failed or printed unexpected output."""


def run(*command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != 0:
        raise Failed(f"{' '.join(command)}\n{done.stdout[-2000:]}")
    return done.stdout


def seconds_in(output, pattern):
    found = re.search(pattern, output)
    if not found:
        raise Failed(f"no rendering time found in the output:\n{output[-2000:]}")
    return float(found[1])


class Peers:
    """Each method renders once and returns the time in seconds."""

    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.width, self.height = options.size.split("x")

    def file(self, name):
        return os.path.join(self.folder, name)

    def exported(self, form):
        path = self.file("scene." + form)
        if not os.path.exists(path):
            text = run(sys.executable, "-B", os.path.join(HERE, "export.py"), form, self.options.scene,
                       "--size", self.options.size, "--samples", str(self.options.samples))
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
        return path

    def orrery(self, precision):
        stats = self.file("stats.json")
        run(self.options.orrery, "render", self.options.scene, "-o", self.file("orrery.exr"), "-t", "1", "-q",
            "--stats", stats, "--width", self.width, "--height", self.height, "--samples", str(self.options.samples),
            "--precision", precision)
        with open(stats, encoding="utf-8") as file:
            return json.load(file)["seconds"]["render"]

    def cycles(self):
        script = os.path.join(HERE, "cycles.py")
        output = run("blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", script, "--",
                     self.options.scene, self.options.size, str(self.options.samples), "1", self.file("cycles.exr"))
        return seconds_in(output, r"seconds ([0-9.]+)")

    def povray(self):
        output = run("povray", "+I" + self.exported("pov"), "+O" + self.file("pov.png"), "+W" + self.width,
                     "+H" + self.height, "+WT1", "-D")
        return seconds_in(output, r"Trace Time:.*\(([0-9.]+) seconds\)")

    def tachyon(self):
        output = run("tachyon", self.exported("tachyon"), "-numthreads", "1", "-fullshade", "-format", "PPM", "-o",
                     self.file("tachyon.ppm"))
        return seconds_in(output, r"Ray Tracing Time: *([0-9.]+)")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("orrery", metavar="ORRERY", help="the orrery executable")
    parser.add_argument("scene", metavar="SCENE.toml")
    parser.add_argument("--size", default="480x270", metavar="WxH", help="image size, px")
    parser.add_argument("--samples", type=int, default=64, help="per pixel")
    parser.add_argument("--rounds", type=int, default=5, help="measurements of each renderer")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        peers = Peers(options, folder)
        ways = {"orrery exact": lambda: peers.orrery("exact"), "orrery fast": lambda: peers.orrery("fast")}
        for name, program, way in (("Cycles", "blender", peers.cycles), ("POV-Ray", "povray", peers.povray),
                                   ("Tachyon", "tachyon", peers.tachyon)):
            if shutil.which(program):
                ways[name] = way
            else:
                print(f"skipped: {name}; {program} is not installed", file=sys.stderr)
        took = {name: [] for name in ways}
        for _ in range(options.rounds):
            for name, way in ways.items():
                took[name].append(way())
    paths = int(peers.width) * int(peers.height) * options.samples
    print(f"{options.size}, {options.samples} samples per pixel, 1 thread, {options.rounds} rounds\n")
    print(f"{'':14}{'M paths/s':>10}  ratio to orrery exact (lowest .. highest round)")
    for name, seconds in took.items():
        ratios = sorted(own / other for own, other in zip(took["orrery exact"], seconds))
        print(f"{name:14}{paths / statistics.median(seconds) / 1e6:10.3g}  {statistics.median(ratios):.3g} "
              f"({ratios[0]:.3g} .. {ratios[-1]:.3g})")


if __name__ == "__main__":
    try:
        main()
    except Failed as failure:
        print(f"run.py: error: {failure}", file=sys.stderr)
        sys.exit(1)
