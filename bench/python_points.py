#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the time to render positions from a NumPy array with that of the program for the same .npy file.

    PYTHONPATH=build/lib/python3/dist-packages bench/python_points.py COUNT FOLDER [PROGRAM]

Both render 64 x 36 pixels with one sample, so that reading the positions and building the BVH take nearly all of the time.
Runs alternate, each in a separate process; the time of Python includes loading the interpreter and the package, but not
making the array. Prints the times, the median of each, and their ratio.
"""

import os
import statistics
import subprocess
import sys
import time

import numpy as np

ROUNDS = 5
SCENE = """[image]
width = 64
height = 36
[render]
samples = 1
[camera]
look_from = [0, 0, 12]
vfov = 40
[material.matte]
type = "lambertian"
albedo = [0.8, 0.8, 0.8]
[[points]]
file = "positions.npy"
material = "matte"
radius = 0.002
"""
PYTHON = """
import sys, time
import numpy as np
begin = time.perf_counter()
positions = np.load("positions.npy")
loaded = time.perf_counter() - begin
import orrery
scene = orrery.Scene(camera=orrery.Camera((0, 0, 12), vfov=40))
scene.add_points(positions, radius=0.002)
scene.render(64, 36, samples=1).write("python.exr", type="float", reproducible=True)
print(loaded)
"""


def main():
    count, folder = int(sys.argv[1]), sys.argv[2]
    program = os.path.abspath(sys.argv[3] if len(sys.argv) > 3 else "build/src/orrery")
    paths = [os.path.abspath(p) for p in os.environ.get("PYTHONPATH", "").split(os.pathsep) if p]
    os.environ["PYTHONPATH"] = os.pathsep.join(paths)
    os.makedirs(folder, exist_ok=True)
    os.chdir(folder)
    with open("scene.toml", "w", encoding="utf-8") as file:
        file.write(SCENE)
    np.save("positions.npy", np.random.default_rng(1).normal(size=(count, 3)))
    commands = {
        "program": [program, "render", "scene.toml", "-o", "program.exr", "-q", "--type", "float", "--reproducible"],
        "python": [sys.executable, "-c", PYTHON],
    }
    times = {name: [] for name in commands}
    for _ in range(ROUNDS):
        for name, command in commands.items():
            begin = time.perf_counter()
            out = subprocess.run(command, check=True, capture_output=True, text=True).stdout
            seconds = time.perf_counter() - begin - (float(out) if name == "python" else 0)
            times[name].append(seconds)
            print(f"{name:8} {seconds:.2f} s", flush=True)
    subprocess.run([program, "compare", "program.exr", "python.exr", "--fail-above", "max=0"], check=True)
    medians = {name: statistics.median(values) for name, values in times.items()}
    print(f"median: {medians}, python / program: {medians['python'] / medians['program']:.3f}")


if __name__ == "__main__":
    main()
