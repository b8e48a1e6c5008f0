#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the denoiser: error, energy, converged images, time and flicker.

    bench/denoise.py build/src/orrery [error] [converged] [time] [flicker] [edges] [--width 320] [--reference 2048]
                                           [--seeds 4] [--scene NAME]

error      factor by which --denoise divides the mean squared display error at 32 samples, over all seeds and its range
           over single ones; the same for values clamped to 0..1 and encoded for the display, which no pixel dominates;
           and the largest change of the image's mean, on the scenes of trade.py and four lit ones; against a reference
           of --reference samples
converged  the same at 4,096 samples, against 16,384
time       seconds of --denoise at 64 samples on the final scene at 1920 x 1080, as a fraction of the render
flicker    mean squared difference of consecutive frames to that of the reference, over 12 frames of a moving camera:
           denoised at 32 samples, relative to 128 samples without
edges      share of the squared error at edges, final scene at 400 x 225 and 32 samples, against 1,024: pixels whose
           albedo differs from a neighbour's by more than a tenth, or whose depth does relative to the smaller one.
           Needs NumPy and the package orrery (PYTHONPATH)
All but the last by default.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import trade  # noqa: E402

ROOT = trade.ROOT
LIT = {name: ROOT / f"scenes/light/{name}.toml" for name in ("three-point", "grey-and-chrome", "thousand-lamps", "caustic")}


def render(program, scene, file, options, *words):
    stats = file.with_suffix(".json")
    trade.run(program, "render", scene, "-o", file, "--type", "float", "-q", "--stats", stats, "--width", options.width,
              "--height", options.width * 9 // 16, *words)
    return json.loads(stats.read_text())


def mean(file):
    text = subprocess.run(["oiiotool", "--stats", file], check=True, capture_output=True, text=True).stdout
    line = next(line for line in text.splitlines() if "Stats Avg" in line)
    return sum(float(word) for word in line.split(":")[1].split()[:3]) / 3


def displayed_error(program, file, reference):
    """Root mean square difference of the display values of two images, 0..1."""
    codes = [image.with_suffix(".tif") for image in (file, reference)]
    for image, code in zip((file, reference), codes):
        trade.run(program, "develop", image, "-o", code, "--bits", 16, "-q")
    return trade.compared(program, *codes)["rmse"]


def measure_error(program, scenes, work, options, samples, reference_samples):
    factors, displayed_factors = [], []
    print(f"{'scene':16} {'samples':>8} {'error':>9} {'denoised':>9} {'factor':>8} {'of one seed':>16} "
          f"{'displayed':>9} {'factor':>8} {'of one seed':>16} {'change of the mean':>19}")
    for name, scene in scenes.items():
        reference, noisy, clean = (work / f"{kind}.exr" for kind in ("reference", "noisy", "clean"))
        render(program, scene, reference, options, "--samples", reference_samples, "--set", "render.seed=999")
        squares, displayed, changes = {noisy: [], clean: []}, {noisy: [], clean: []}, []
        for seed in range(1, options.seeds + 1):
            render(program, scene, noisy, options, "--samples", samples, "--layers", "halves",
                   "--set", f"render.seed={seed}")
            trade.run(program, "denoise", noisy, "-o", clean, "-q")
            for file in (noisy, clean):
                squares[file].append(trade.compared(program, file, reference)["display"] ** 2)
                displayed[file].append(displayed_error(program, file, reference) ** 2)
            changes.append(mean(clean) / mean(noisy) - 1)
        columns = [f"{name:16} {samples:8} {statistics.fmean(squares[noisy]) ** 0.5:9.5f}"]
        for errors, to in ((squares, factors), (displayed, displayed_factors)):
            before, after = (statistics.fmean(errors[file]) for file in (noisy, clean))
            of_seed = [b / a if a > 0 else 1 for b, a in zip(errors[noisy], errors[clean])]
            to.append(before / after if after > 0 else 1)
            spread = f"{min(of_seed):.2f} .. {max(of_seed):.2f}"
            columns.append(f"{after ** 0.5:9.5f} {to[-1]:8.2f} {spread:>16}")
        print(*columns, f"{max(changes, key=abs):19.1e}", flush=True)
    for kind, of in (("", factors), (" of displayed values", displayed_factors)):
        print(f"median factor{kind} {statistics.median(of):.2f}, smallest {min(of):.2f}", flush=True)
    print()


def measure_time(program, scene, work, options):
    options = argparse.Namespace(width=1920)
    plain = render(program, scene, work / "plain.exr", options, "--samples", 64)["seconds"]
    denoised = render(program, scene, work / "time.exr", options, "--samples", 64, "--denoise")["seconds"]
    print(f"1920 x 1080, 64 samples: render {plain['render']:.2f} s, with --denoise {denoised['render']:.2f} s, "
          f"finish {denoised['finish']:.2f} s, denoise {denoised['denoise']:.2f} s: "
          f"{100 * denoised['denoise'] / plain['render']:.1f} % of the render; "
          f"in total {100 * (sum(denoised.values()) / sum(plain.values()) - 1):.1f} % more time\n", flush=True)


def measure_flicker(program, work, options):
    text = (ROOT / "scenes/book/final.toml").read_text()
    ways = {"denoised": ["--samples", 32, "--denoise"], "more samples": ["--samples", 128],
            "reference": ["--samples", 1024]}
    frames = {way: [] for way in ways}
    scene = work / "turntable.toml"
    scene.write_text(text)
    for frame in range(12):
        angle = f"camera.look_from=[{13 - 0.05 * frame:.3f}, 2, {3 + 0.2 * frame:.3f}]"
        for way, words in ways.items():
            file = work / f"{way.replace(' ', '-')}.{frame}.exr"
            render(program, scene, file, options, *words, "--set", angle, "--set", f"render.seed={100 + frame}")
            frames[way].append(file)
    flicker = {}
    for way in ("denoised", "more samples"):
        # The flicker is the change of the error from frame to frame.
        squares = []
        for frame in range(1, 12):
            change = work / "change.exr"
            subprocess.run(["oiiotool", frames[way][frame], frames["reference"][frame], "--sub", frames[way][frame - 1],
                            frames["reference"][frame - 1], "--sub", "--sub", "--dup", "--mul", "-o", change], check=True)
            squares.append(mean(change))
        flicker[way] = statistics.fmean(squares)
    print(f"flicker of 12 frames: denoised at 32 samples {flicker['denoised']:.2e}, 128 samples "
          f"{flicker['more samples']:.2e}, ratio {flicker['denoised'] / flicker['more samples']:.2f}", flush=True)


def measure_edges():
    import numpy as np
    import orrery
    scene = orrery.load(str(ROOT / "scenes/book/final.toml"))
    scene.set("output.layers", ["albedo", "Z"])

    def picture(seed, samples, **options):
        scene.set("render.seed", seed)
        return scene.render(400, 225, samples=samples, **options)

    def display(image):
        x = np.clip(image.beauty[..., :3], 0, 1)
        return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)

    reference = picture(999, 1024)
    noisy, clean = (((display(picture(1, 32, denoise=denoise)) - display(reference)) ** 2).sum(-1)
                    for denoise in (False, True))
    albedo, depth = reference["albedo"], reference["Z"]
    edge = np.zeros(depth.shape, bool)
    for rows, columns in ((1, 0), (0, 1)):
        one = slice(rows, None), slice(columns, None)
        other = slice(None, -rows or None), slice(None, -columns or None)
        differs = (abs(albedo[one] - albedo[other]) > 0.1).any(-1)
        differs |= abs(depth[one] - depth[other]) > 0.1 * np.minimum(depth[one], depth[other])
        edge[one] |= differs
        edge[other] |= differs
    print(f"{100 * edge.mean():.0f} % of the pixels are at edges, with {100 * noisy[edge].sum() / noisy.sum():.0f} % of the "
          f"squared error before and {100 * clean[edge].sum() / clean.sum():.0f} % after denoising. Error divided by "
          f"{(noisy[edge].sum() / clean[edge].sum()) ** 0.5:.2f} there, by "
          f"{(noisy[~edge].sum() / clean[~edge].sum()) ** 0.5:.2f} elsewhere, by "
          f"{(noisy.sum() / clean.sum()) ** 0.5:.2f} in all", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the orrery executable")
    parser.add_argument("figure", nargs="*", help="error, converged, time, flicker, edges")
    parser.add_argument("--width", type=int, default=320, help="image width, px")
    parser.add_argument("--reference", type=int, default=2048, help="samples of the references of `error`")
    parser.add_argument("--seeds", type=int, default=4, help="number of seeds of `error` and `converged`")
    parser.add_argument("--scene", action="append", help="measure only this scene; can be repeated")
    options = parser.parse_args()
    figures = options.figure or ["error", "converged", "time", "flicker"]
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        scenes = {**trade.scenes(options.program, work), **LIT}
        scenes = {name: scene for name, scene in scenes.items() if not options.scene or name in options.scene}
        if "error" in figures:
            measure_error(options.program, scenes, work, options, 32, options.reference)
        if "converged" in figures:
            measure_error(options.program, scenes, work, options, 4096, 16384)
        if "time" in figures:
            measure_time(options.program, ROOT / "scenes/book/final.toml", work, options)
        if "flicker" in figures:
            measure_flicker(options.program, work, options)
    if "edges" in figures:
        measure_edges()
    return 0


if __name__ == "__main__":
    sys.exit(main())
