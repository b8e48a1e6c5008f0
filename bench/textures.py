#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the benefit, the cost and the bias of filtering image textures with mip maps.

    bench/textures.py BEFORE AFTER... [--runs 5] [--scene NAME] [--reference 8192]

BEFORE and AFTER are orrery executables: one that does not filter, such as a build with kConeWidth = 0
(src/compile/textures.h), and others. For every scene, prints for each program the relative display error at 16, 64 and
1,024 samples per pixel and seed 5 against an image of BEFORE with --reference samples; the largest difference of a value
from BEFORE at 1,024 samples with the same seed; and the time of a sample relative to BEFORE (64 samples on one thread at
160 x 90 pixels, medians of alternating runs). Maps have 4096 x 2048 texels: "noise" is independent in each, "cells" are
16 x 8 rectangles of black and white with hard edges.
"""
import argparse
import json
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

WIDTH, HEIGHT = 4096, 2048
COUNTS = (16, 64, 1024)
SIZE = ("--width", 64, "--height", 36)

HEAD = """
[camera]
look_from = [0, {height}, {distance}]
look_at = [0, 0, 0]
vfov = 25
{camera}
[background]
type = "constant"
color = [{sky}, {sky}, {sky}]
[material]
map = {{ type = "{model}", {key} = {{ texture = "image", file = "{map}.ppm", color_space = "lin_rec709" }} }}
mirror = {{ type = "metal", albedo = [0.9, 0.9, 0.9] }}
glass = {{ type = "dielectric" }}
white = {{ type = "lambertian", albedo = [0.8, 0.8, 0.8] }}
brushed = {{ type = "metal", albedo = [0.9, 0.9, 0.9], fuzz = 0.3 }}
"""


def sphere(center, radius, material):
    return f'[[sphere]]\ncenter = {list(center)}\nradius = {radius}\nmaterial = "{material}"\n'


def scene(name, texels):
    ball = sphere((0, 0, 0), 2, "map")
    ground = sphere((0, -101, 0), 100, "white")
    pair = sphere((-1.1, 0, 0), 1, "white") + sphere((1.1, 0, 0), 1, "brushed") + ground
    head = {"height": 0, "distance": 12, "camera": "", "sky": 1, "model": "lambertian", "key": "albedo", "map": texels}
    lamp = dict(head, height=1, distance=8, sky=0, model="emitter", key="radiance")
    if name == "planet":  # 45 pixels wide, about 29 texels to a pixel in the centre
        return HEAD.format(**head) + ball
    if name == "lens":
        return HEAD.format(**dict(head, camera="defocus_angle = 6\nfocus_distance = 6")) + ball
    if name == "mirror and glass":
        return (HEAD.format(**dict(head, height=1, distance=8)) + sphere((-1.1, 0, 0), 1, "mirror") +
                sphere((1.1, 0, 0), 1, "glass") + sphere((0, -101, 0), 100, "white") + sphere((0, 1, 11), 2, "map") +
                sphere((2, 1, -6), 2, "map"))
    if name == "lamp":
        return HEAD.format(**lamp) + pair + sphere((0, 1.5, 0.5), 0.6, "map")
    return HEAD.format(**lamp) + pair + sphere((0, 0, 0), 1000, "map")  # dome


def write_maps(folder):
    def write(name, rows):
        with open(folder / name, "wb") as out:
            out.write(b"P6\n%d %d\n255\n" % (WIDTH, HEIGHT))
            for row in rows:
                out.write(row)

    texels = random.Random(1)
    write("noise.ppm", (texels.randbytes(3 * WIDTH) for _ in range(HEIGHT)))
    stripes = [b"".join((b"\xff\xff\xff" if (x + odd) % 2 else b"\0\0\0") * (WIDTH // 16) for x in range(16))
               for odd in (0, 1)]
    write("cells.ppm", (stripes[y * 8 // HEIGHT % 2] for y in range(HEIGHT)))


def render(program, toml, picture, *words):
    stats = picture.with_suffix(".json")
    subprocess.run([program, "render", toml, "-o", picture, "--type", "float", "-q", "--stats", stats,
                    *map(str, words)], check=True)
    return json.loads(stats.read_text())["seconds"]["render"]


def compare(program, a, b):
    return json.loads(subprocess.run([program, "compare", a, b, "--json"], check=True, capture_output=True,
                                     text=True).stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+", metavar="PROGRAM")
    parser.add_argument("--runs", type=int, default=5, help="of the time measurement")
    parser.add_argument("--scene", action="append", help="measure only this scene; can be repeated")
    parser.add_argument("--reference", type=int, default=8192, help="samples of the reference")
    options = parser.parse_args()
    before = options.programs[0]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_maps(folder)
        print(f"{'scene':24} program" + "".join(f"{n:>9}" for n in COUNTS) + "  largest difference   time")
        for kind in ("planet", "lens", "mirror and glass", "lamp", "dome"):
            for texels in ("noise", "cells"):
                title = f"{kind}, {texels}"
                if options.scene and title not in options.scene and kind not in options.scene:
                    continue
                toml = folder / "scene.toml"
                toml.write_text(scene(kind, texels))
                reference, unfiltered, picture = (folder / f"{n}.exr" for n in ("reference", "unfiltered", "picture"))
                render(before, toml, reference, *SIZE, "--samples", options.reference, "--set", "render.seed=99")
                render(before, toml, unfiltered, *SIZE, "--samples", COUNTS[-1], "--set", "render.seed=5")
                seconds = [[] for _ in options.programs]
                for _ in range(options.runs):
                    for program, times in zip(options.programs, seconds):
                        times.append(render(program, toml, picture, "--width", 160, "--height", 90, "--samples", 64,
                                            "-t", 1))
                for i, program in enumerate(options.programs):
                    errors = []
                    for count in COUNTS:
                        render(program, toml, picture, *SIZE, "--samples", count, "--set", "render.seed=5")
                        errors.append(compare(before, picture, reference)["display"])
                    difference = compare(before, picture, unfiltered)["max"]
                    print(f"{title if i == 0 else '':24} {i:7}" + "".join(f"{e:9.4f}" for e in errors) +
                          f"{difference:20.4f} {statistics.median(seconds[i]) / statistics.median(seconds[0]):6.2f}",
                          flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
