#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the benefit and the cost of light sampling.

    bench/lights.py build/src/orrery [--runs 5] [--width 320] [--samples 64] [--scene NAME]

For every lit scene: the root mean square error of BSDF sampling (`direct_lighting = "bsdf"`) divided by that of multiple
importance sampling, with the same samples and in the same time, against a reference with 64 times the samples. Then the
time of a sample of the book's final scene with three lamps, relative to that without lamps. All variants run in turn with
each seed, on all threads; times are medians.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent

STAGE = """
[camera]
look_from = [0, 3, 8]
look_at = [0, 0.8, 0]
vfov = 30
[render]
max_depth = 5
[material]
floor = { type = "lambertian", albedo = [0.5, 0.5, 0.5] }
ball = { type = "lambertian", albedo = [0.7, 0.3, 0.2] }
brushed = { type = "metal", albedo = [0.8, 0.8, 0.8], fuzz = 0.5 }
[[sphere]]
center = [0, -1000, 0]
radius = 1000
material = "floor"
"""


def sphere(center, radius, material):
    return f'[[sphere]]\ncenter = {center}\nradius = {radius}\nmaterial = "{material}"\n'


PENUMBRA = ('[background]\ntype = "constant"\ncolor = [0, 0, 0]\n' + STAGE +
            '[material.lamp]\ntype = "emitter"\nradiance = [200, 180, 150]\n' +
            sphere([0, 1, 0], 1, "ball") + sphere([3, 5, 2], 0.2, "lamp"))

# Balls under the image of a clear sky, a few texels of which hold the sun.
IMAGE_SKY = ('[background]\ntype = "image"\nfile = "sky.exr"\n' + STAGE +
             sphere([-1, 1, 0], 1, "ball") + sphere([1, 1, 0], 1, "brushed"))


def run(program, *words):
    return subprocess.run([program, *map(str, words)], check=True, capture_output=True, text=True).stdout


def render(program, scene, picture, words):
    stats = picture.with_suffix(".json")
    run(program, "render", scene, "-o", picture, "--type", "float", "-q", "--stats", stats, *words)
    return json.loads(stats.read_text())["seconds"]["render"]


def error(program, picture, reference):
    return json.loads(run(program, "compare", picture, reference, "--json"))["rmse"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the orrery executable")
    parser.add_argument("--runs", type=int, default=5, help="number of seeds")
    parser.add_argument("--width", type=int, default=320, help="image width, px")
    parser.add_argument("--samples", type=int, default=64, help="per pixel")
    parser.add_argument("--scene", action="append", help="measure only this scene; can be repeated")
    options = parser.parse_args()
    size = ["--width", options.width, "--height", options.width * 9 // 16]
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        (work / "penumbra.toml").write_text(PENUMBRA)
        (work / "image-sky.toml").write_text(IMAGE_SKY)
        run(options.program, "generate", "env", "sky", "-o", work / "sky.exr")
        scenes = {"penumbra": work / "penumbra.toml", "image-sky": work / "image-sky.toml"}
        for name in ("three-point", "thousand-lamps", "caustic", "eclipse-ground"):
            scenes[name] = ROOT / f"scenes/light/{name}.toml"
        print(f"{'scene':16} {'time of a sample':>17} {'error, same samples':>20} {'error, same time':>17}")
        for name, scene in scenes.items():
            if options.scene and name not in options.scene:
                continue
            reference = work / "reference.exr"
            render(options.program, scene, reference, [*size, "--samples", 64 * options.samples,
                                                         "--set", "render.seed=999"])
            seconds, errors = {"mis": [], "bsdf": []}, {"mis": [], "bsdf": []}
            for seed in range(1, options.runs + 1):
                for mode in seconds:
                    picture = work / "picture.exr"
                    seconds[mode].append(render(options.program, scene, picture, [
                        *size, "--samples", options.samples, "--set", f"render.seed={seed}",
                        "--set", f"render.direct_lighting={mode}"]))
                    errors[mode].append(error(options.program, picture, reference))
            time = statistics.median(seconds["mis"]) / statistics.median(seconds["bsdf"])
            worse = (statistics.fmean(e * e for e in errors["bsdf"]) / statistics.fmean(e * e for e in errors["mis"])) ** 0.5
            print(f"{name:16} {time:17.2f} {worse:20.1f} {worse / time ** 0.5:17.1f}", flush=True)
        lit, unlit = [], []
        for seed in range(1, options.runs + 1):
            for scene, times in ((ROOT / "scenes/light/three-point.toml", lit), (ROOT / "scenes/book/final.toml", unlit)):
                times.append(render(options.program, scene, work / "picture.exr", [
                    *size, "--samples", options.samples, "--set", f"render.seed={seed}",
                    "--set", "render.max_depth=50", "--set", "output.layers=[]"]))
        print(f"\ntime of a sample, final scene with three lamps / without: "
              f"{statistics.median(lit) / statistics.median(unlit):.2f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
