#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the benefit and the cost of light sampling, or of sampled caustics.

    bench/lights.py build/src/orrery [--caustics] [--runs 5] [--width 320] [--samples 64] [--scene NAME]

For every lit scene: the root mean square error of BSDF sampling (`direct_lighting = "bsdf"`) divided by that of multiple
importance sampling, with the same samples and in the same time, against a reference with 64 times the samples. Then the
time of a sample of the book's final scene with three lamps, relative to that without lamps. All variants run in turn with
each seed, on all threads; times are medians.

With --caustics, the same for `caustics = false` and `true`, and the ratios of the mean square errors, which are those of
the variances and of the times to an equal error. They are those of the layer `diffuse_indirect`, since what the camera
sees in mirrors and glass has other noise. Paths rarely find small lamps by chance: with too few runs ratios are too
small.
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


def lamps(*of):
    """Lamps of equal power: (center, radius) each."""
    return "".join(f'[material.lamp{i}]\ntype = "emitter"\nradiance = {[6.4 / radius**2] * 3}\n' +
                   sphere(center, radius, f"lamp{i}") for i, (center, radius) in enumerate(of))


CAUSTICS = ('[background]\ntype = "constant"\ncolor = [0.05, 0.05, 0.05]\n' + STAGE +
            '[material.glass]\ntype = "dielectric"\nior = 1.5\n' +
            '[material.mirror]\ntype = "metal"\nalbedo = [0.95, 0.95, 0.95]\nfuzz = 0\n')
DISTANT_LAMP = ('[material.sun]\ntype = "emitter"\nradiance = [40000, 40000, 40000]\n' +
                sphere([-5000, 8000, 2500], 45, "sun"))  # as large as the sun
SMALL_LAMP = CAUSTICS + sphere([0, 1, 0], 1, "glass") + lamps(([-3, 5, 1.5], 0.1))
THREE_LAMPS = (CAUSTICS + sphere([-1.1, 1, 0], 1, "glass") + sphere([1.2, 0.8, 0.4], 0.8, "mirror") +
               lamps(([-3, 5, 1.5], 0.05), ([3, 4, 2], 0.3), ([0, 5, -4], 1)))
LIT = {"penumbra": PENUMBRA, "image-sky": IMAGE_SKY}
WITH_CAUSTICS = {"small-lamp": SMALL_LAMP, "hollow": SMALL_LAMP + sphere([0, 1, 0], -0.8, "glass"),
                 "mirror-and-sun": CAUSTICS + sphere([0, 1, 0], 1, "mirror") + DISTANT_LAMP,
                 "core": SMALL_LAMP + sphere([0, 1, 0], 0.5, "ball"), "three-lamps": THREE_LAMPS}


def measure(program, scene, work, options, before, after):
    """Returns the time of a sample and the mean square error after a change of the settings, divided by those before."""
    size = ["--width", options.width, "--height", options.width * 9 // 16]
    layers, layer = ((["--layers", "diffuse"], ["--layer", "diffuse_indirect"]) if options.caustics else ([], []))
    reference, picture = work / "reference.exr", work / "picture.exr"
    render(program, scene, reference, [*size, *layers, "--samples", 64 * options.samples, "--set", "render.seed=999"])
    seconds, errors = {before: [], after: []}, {before: [], after: []}
    for seed in range(1, options.runs + 1):
        for setting in seconds:
            seconds[setting].append(render(program, scene, picture, [
                *size, *layers, "--samples", options.samples, "--set", f"render.seed={seed}", "--set", setting]))
            errors[setting].append(error(program, picture, reference, layer) ** 2)
    return (statistics.median(seconds[after]) / statistics.median(seconds[before]),
            statistics.fmean(errors[after]) / statistics.fmean(errors[before]))


def run(program, *words):
    return subprocess.run([program, *map(str, words)], check=True, capture_output=True, text=True).stdout


def render(program, scene, picture, words):
    stats = picture.with_suffix(".json")
    run(program, "render", scene, "-o", picture, "--type", "float", "-q", "--stats", stats, *words)
    return json.loads(stats.read_text())["seconds"]["render"]


def error(program, picture, reference, layer):
    return json.loads(run(program, "compare", picture, reference, "--json", *layer))["rmse"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the orrery executable")
    parser.add_argument("--caustics", action="store_true", help="measure sampled caustics")
    parser.add_argument("--runs", type=int, default=5, help="number of seeds")
    parser.add_argument("--width", type=int, default=320, help="image width, px")
    parser.add_argument("--samples", type=int, default=64, help="per pixel")
    parser.add_argument("--scene", action="append", help="measure only this scene; can be repeated")
    options = parser.parse_args()
    size = ["--width", options.width, "--height", options.width * 9 // 16]
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        run(options.program, "generate", "env", "sky", "-o", work / "sky.exr")
        scenes = {}
        for name, text in (WITH_CAUSTICS if options.caustics else LIT).items():
            scenes[name] = work / f"{name}.toml"
            scenes[name].write_text(text)
        for name in (("grey-and-chrome", "glass-in-the-sun", "caustic", "paperweights", "marbles", "three-point",
                      "thousand-lamps")
                     if options.caustics else ("three-point", "thousand-lamps", "caustic", "eclipse-ground")):
            scenes[name] = ROOT / f"scenes/light/{name}.toml"
        before, after = [f"render.{setting}" for setting in (
            ("caustics=false", "caustics=true") if options.caustics else ("direct_lighting=bsdf", "direct_lighting=mis"))]
        of = "variance" if options.caustics else "error"
        print(f"{'scene':16} {'time of a sample':>17} {of + ', same samples':>23} {of + ', same time':>20}")
        for name, scene in scenes.items():
            if options.scene and name not in options.scene:
                continue
            time, square = measure(options.program, scene, work, options, before, after)
            power = 1 if options.caustics else 0.5
            print(f"{name:16} {time:17.2f} {square ** -power:23.1f} {(square * time) ** -power:20.1f}", flush=True)
        if options.caustics:
            return 0
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
