#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Whether --noise reaches what it promises: true errors by asked ones, over five scenes and many seeds.

    bench/promise.py build/src/orrery [--seeds 20] [--noise 0.02] [--width 160]

True errors are those of `orrery compare`, "display", against a reference of --noise at a sixth; its own squared error,
known from its statistics, is taken off. Exit status 1 where fewer than 95 in 100 are within a fifth.
"""
import argparse
import json
import pathlib
import statistics
import sys
import tempfile

import trade


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--noise", type=float, default=0.02)
    parser.add_argument("--width", type=int, default=160)
    options = parser.parse_args()
    size = ["--width", options.width, "--height", options.width * 9 // 16]
    kept = total = 0
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        for name, scene in trade.scenes(options.program, work).items():
            reference, told = trade.render(options.program, scene, work, size, ["--noise", options.noise / 6, "--seed", 999])
            reference = reference.rename(work / "reference.exr")
            ratios, biases = [], []
            for seed in range(1, options.seeds + 1):
                words = ["--noise", options.noise, "--seed", seed]
                picture, _ = trade.render(options.program, scene, work, size, words)
                found = trade.compared(options.program, picture, reference)
                error = max(0, found["display"] ** 2 - told["noise"] ** 2) ** 0.5
                ratios.append(error / options.noise)
                biases.append(found["bias"])
            kept += sum(abs(r - 1) <= 0.2 for r in ratios)
            total += len(ratios)
            spread = statistics.stdev(biases) / len(biases) ** 0.5
            print(f"{name:14} true by asked {min(ratios):.3f} .. {statistics.median(ratios):.3f} .. {max(ratios):.3f}, "
                  f"bias {statistics.fmean(biases):+.1e}, standard error {spread:.0e}", flush=True)
    print(f"{kept} of {total} within a fifth")
    return 0 if kept >= 0.95 * total else 1


if __name__ == "__main__":
    sys.exit(main())
