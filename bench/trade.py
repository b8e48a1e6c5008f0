#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the benefit of samplers, Russian roulette and adaptive sampling: the time for the same error, and the error
in the same time.

    bench/trade.py build/src/orrery [--runs 5] [--width 320] [--noise 0.01] [--scene NAME]

Uses five scenes. The error is the display error of `orrery compare` against a reference rendered with a quarter of the
target noise. All methods are rendered with each seed in turn, on all threads; times are medians, errors root mean
squares. The baseline is the book's method: independent samples, uniform over the image, without Russian roulette. Times
are scaled to equal error by the square of the error.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent

WAYS = {
    "independent": ["--set", "render.sampler=independent", "--set", "render.roulette_depth=0"],
    "+ roulette": ["--set", "render.sampler=independent"],
    "sobol": [],
    "blue-noise": ["--set", "render.sampler=blue-noise"],
    "adaptive": None,  # --noise
}


def run(program, *words):
    subprocess.run([program, *map(str, words)], check=True)


def render(program, scene, work, size, words):
    picture, stats = work / "picture.exr", work / "stats.json"
    run(program, "render", scene, "-o", picture, "--type", "float", "-q", "--stats", stats, *size, *words)
    told = json.loads(stats.read_text())
    return picture, told


def compared(program, picture, reference):
    done = subprocess.run([program, "compare", picture, reference, "--json"], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def scenes(program, work):
    run(program, "generate", "cloud", "-o", work / "cloud.toml", "--count", 100000)
    return {
        "final": ROOT / "scenes/book/final.toml",
        "cloud of 100k": work / "cloud.toml",
        "glass": ROOT / "scenes/trade/glass.toml",
        "defocus": ROOT / "scenes/trade/defocus.toml",
        "contrast": ROOT / "scenes/trade/contrast.toml",
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the orrery executable")
    parser.add_argument("--runs", type=int, default=5, help="number of seeds")
    parser.add_argument("--width", type=int, default=320, help="image width, px")
    parser.add_argument("--noise", type=float, default=0.01, help="target noise")
    parser.add_argument("--scene", action="append", help="measure only this scene; can be repeated")
    options = parser.parse_args()
    size = ["--width", options.width, "--height", options.width * 9 // 16]
    print(f"{'scene':14} {'method':12} {'samples':>8} {'seconds':>8} {'error':>8} {'time for the same error':>24} "
          f"{'error in the same time':>23}")
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        for name, scene in scenes(options.program, work).items():
            if options.scene and name not in options.scene:
                continue
            reference, _ = render(options.program, scene, work, size,
                                  ["--noise", options.noise / 4, "--set", "render.seed=999"])
            reference = reference.rename(work / "reference.exr")
            # All methods get about as many samples as adaptive sampling, so that their errors are similar.
            _, told = render(options.program, scene, work, size, ["--noise", options.noise, "--set", "render.seed=998"])
            samples = 1 << max(4, round(told["samples"]).bit_length() - 1)
            found = {way: ([], [], []) for way in WAYS}
            for seed in range(1, options.runs + 1):
                for way, words in WAYS.items():
                    words = ["--noise", options.noise] if words is None else [*words, "--samples", samples]
                    picture, told = render(options.program, scene, work, size, [*words, "--set", f"render.seed={seed}"])
                    found[way][0].append(told["seconds"]["render"])
                    found[way][1].append(compared(options.program, picture, reference)["display"])
                    found[way][2].append(told["samples"])
            base = None
            for way, (seconds, errors, counts) in found.items():
                time = statistics.median(seconds)
                error = statistics.fmean(e * e for e in errors) ** 0.5
                cost = time * error * error
                base = base or cost
                print(f"{name:14} {way:12} {statistics.fmean(counts):8.1f} {time:8.2f} {error:8.5f} "
                      f"{cost / base:24.3f} {(cost / base) ** 0.5:23.3f}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
