#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests --noise in ten scenes of lamps that the camera sees, made after these lamps were sampled.

    bench/seen_lamps.py build/src/orrery [--seeds 10] [--samples 16384] [--scene NAME]

Prints true error / target (median and maximum over the seeds), the samples per pixel, and the error of the reference /
target, which is subtracted. Exit status 1 if a true error exceeds 1.1 times its target.
"""
import argparse
import math
import pathlib
import random
import re
import statistics
import subprocess
import sys
import tempfile

CAMERA = "look_from = [0, 2, 10]\nlook_at = [0, 1.5, 0]\nvfov = 35\n"
MATERIALS = """[material]
floor = { type = "lambertian", albedo = [0.4, 0.4, 0.4] }
chrome = { type = "metal", albedo = [0.9, 0.9, 0.9] }
gloss = { type = "plastic", albedo = [0.2, 0.3, 0.6], fuzz = 0 }
soot = { type = "lambertian", albedo = [0.02, 0.02, 0.02] }
veil = { type = "lambertian", albedo = [0.1, 0.1, 0.1], opacity = 0.4 }
clear = { type = "dielectric" }
"""


def lens(angle, focus):
    return f"defocus_angle = {angle}\nfocus_distance = {focus}\n"


def sphere(material, x, y, z, radius):
    return f'[[sphere]]\ncenter = [{x}, {y}, {z}]\nradius = {radius}\nmaterial = "{material}"\n'


def lamps(count, seed, x, y, z, radius, radiance):
    """Lamps whose places, radii and radiances are uniform in these ranges."""
    numbers = random.Random(seed)
    out = ""
    for i in range(count):
        place = [numbers.uniform(*limits) for limits in (x, y, z, radius)]
        light = numbers.uniform(*radiance)
        out += f'[material.lamp{i}]\ntype = "emitter"\nradiance = [{light}, {0.8 * light}, {0.5 * light}]\n'
        out += sphere(f"lamp{i}", *place)
    return out


# Name: camera, keys of [render], lamps and other spheres.
SCENES = {
    "street": (lens(2, 8), "", lamps(40, 1, (-20, 20), (0.5, 8), (-60, -20), (0.05, 0.4), (20, 300))),
    "before the focus": (lens(3, 10), "", lamps(8, 2, (-1, 1), (1, 3), (5, 8), (0.005, 0.02), (200, 3000))),
    "galaxy": ("", "", lamps(400, 3, (-20, 20), (1, 14), (-40, -20), (0.005, 0.05), (10, 2000))),
    "filtered galaxy": ("", 'filter = "gaussian"\n',
                        lamps(150, 4, (-20, 20), (1, 14), (-40, -20), (0.01, 0.08), (10, 1000))),
    "veiled": (lens(3, 6), "", lamps(10, 5, (-8, 8), (1, 6), (-20, -15), (0.05, 0.2), (100, 2000)) +
               "".join(sphere("veil", x, 1.5, 2, 0.6) for x in (-2, 0, 2))),
    "screened": (lens(3, 9), "", lamps(12, 6, (-8, 8), (1, 6), (-25, -15), (0.05, 0.2), (100, 2000)) +
                 "".join(sphere("soot", 0.8 * i - 3, 1.5 + 0.4 * (i % 3), 1, 0.3) for i in range(9))),
    "in focus": (lens(1, 10), "", lamps(30, 7, (-3, 3), (0.5, 3.5), (-0.1, 0.1), (0.004, 0.03), (50, 2000))),
    "glossy": ("", "", lamps(3, 8, (-4, 4), (3, 6), (2, 6), (0.05, 0.15), (100, 1000)) +
               "".join(sphere("gloss", 0.5 * i - 3, 0.2, 0.6 * (i % 4), 0.2) for i in range(13))),
    "chrome": (lens(2, 9), "", lamps(6, 9, (-8, 8), (2, 6), (-18, -10), (0.1, 0.3), (50, 400)) +
               sphere("chrome", -1, 0.8, 0, 0.8) + sphere("gloss", 1, 0.6, 1, 0.6)),
    "mixed sizes": (lens(4, 12), "", lamps(15, 10, (-10, 10), (1, 7), (-20, 6), (0.01, 1), (5, 500)) +
                    sphere("clear", 0, 0.7, 1, 0.7)),
}


def scene_text(name):
    camera, render, spheres = SCENES[name]
    return (f"[image]\nwidth = 64\nheight = 36\n[camera]\n{CAMERA}{camera}[render]\n{render}"
            f'[background]\ntype = "constant"\ncolor = [0.03, 0.03, 0.04]\n{MATERIALS}'
            f"{sphere('floor', 0, -1000, 0, 1000)}{spheres}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--samples", type=int, default=16384, help="per pixel, of each of two references")
    parser.add_argument("--scene", choices=SCENES, action="append")
    args = parser.parse_args()
    folder = pathlib.Path(tempfile.mkdtemp())

    def run(*words):
        done = subprocess.run([args.program, *map(str, words)], check=True, capture_output=True, text=True)
        return done.stdout + done.stderr

    def error(a, b):
        return float(re.search(r"display\s+(\S+)", run("compare", folder / a, folder / b))[1])

    failed = False
    for name in args.scene or SCENES:
        scene = folder / "scene.toml"
        scene.write_text(scene_text(name))

        def render(image, seed, *words):
            text = run("render", scene, "-o", folder / image, "--set", f"render.seed={seed}", *words)
            return float(re.search(r"([0-9.]+) samples per pixel", text)[1])

        for seed in (998, 999):
            render(f"{seed}.exr", seed, "--samples", args.samples)
        reference = error("998.exr", "999.exr") / math.sqrt(2)
        for target in (0.1, 0.03):
            samples, errors = [], []
            for seed in range(1, args.seeds + 1):
                samples.append(render("image.exr", seed, "--noise", target, "--samples", 20000))
                square = error("image.exr", "999.exr") ** 2 - reference ** 2
                errors.append(math.sqrt(max(square, 0)) / target)
            failed = failed or max(errors) > 1.1
            print(f"{name:16s} {target:<4} true error / target {statistics.median(errors):.2f}, at most "
                  f"{max(errors):.2f}; samples {statistics.median(samples):.0f}; reference {reference / target:.2f}",
                  flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
