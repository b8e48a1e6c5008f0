#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the cost of interruptions: a render stopped and resumed thirty times, relative to one that is not.

    bench/interruptions.py PROGRAM [--scene FILE] [--times N] [--seconds S]

All runs are timed as whole processes. The uninterrupted render runs once before and once after the interrupted one; the
ratio is to the mean of the two. The images must be byte-identical. Exit status 1 if they differ or a render fails.
"""
import argparse
import pathlib
import random
import signal
import subprocess
import tempfile
import time

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("program", type=pathlib.Path, help="the orrery executable")
parser.add_argument("--scene", type=pathlib.Path, default=pathlib.Path(__file__).parent.parent / "scenes/book/final.toml")
parser.add_argument("--times", type=int, default=30, help="number of interruptions")
parser.add_argument("--seconds", type=float, default=60, help="approximate duration of the uninterrupted render")
arguments = parser.parse_args()
program = arguments.program.resolve()
random.seed(1)

with tempfile.TemporaryDirectory() as folder:
    base = [program, "render", arguments.scene.resolve(), "--width", "480", "--height", "270", "--reproducible", "-q"]

    def run(samples, name):
        start = time.monotonic()
        subprocess.run([*base, "--samples", str(samples), "-o", name], check=True, cwd=folder)
        return time.monotonic() - start

    seconds_per_sample = (run(64, "speed.exr") - run(16, "speed.exr")) / 48
    samples = max(16, int(arguments.seconds / seconds_per_sample))
    before = run(samples, "whole.exr")
    command = [*base, "--samples", str(samples), "-o", "parts.exr", "--resume"]
    spent, interruptions = 0.0, 0
    while True:
        start = time.monotonic()
        process = subprocess.Popen(command, cwd=folder, stderr=subprocess.DEVNULL)
        if interruptions < arguments.times:
            try:
                process.wait(random.uniform(0.3, 1.8 * before / (arguments.times + 1)))
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGTERM)
        status = process.wait()
        spent += time.monotonic() - start
        if status not in (75, -signal.SIGTERM):  # the second: no signal handler was installed yet
            break
        interruptions += 1
    after = run(samples, "whole.exr")
    whole = (before + after) / 2
    same = pathlib.Path(folder, "whole.exr").read_bytes() == pathlib.Path(folder, "parts.exr").read_bytes()
    print(f"{samples} samples: {before:.1f} s uninterrupted before and {after:.1f} s after, "
          f"{spent:.1f} s with {interruptions} interruptions, "
          f"ratio {spent / whole:.3f}; exit status {status}; the images are {'identical' if same else 'DIFFERENT'}")
    raise SystemExit(0 if same and status == 0 else 1)
