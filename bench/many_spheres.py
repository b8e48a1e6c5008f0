#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Benchmarks many spheres: uniform clouds and dense crystals as binary PLY files in single precision.

    bench/many_spheres.py build/src/orrery                       1 and 10 million, one thread
    bench/many_spheres.py build/src/orrery --counts 100000
    bench/many_spheres.py build/src/orrery --radii               spheres of many sizes
    bench/many_spheres.py build/src/orrery --whole 100000000     from command to image, all threads
    bench/many_spheres.py build/src/orrery --capsids 1M4X.pdb    the same for six copies of a PDB file's assembly 1
    bench/many_spheres.py build/src/orrery --against OTHER       times of a render relative to another build's

For each scene the first form prints closest hits per second of `bench_tracing`, which is taken from the folder `bench` of
the build (the BVH for many spheres with single rays
and with packets, one Embree primitive per sphere, Embree's sphere points), the ratio of the scene's accelerator to sphere
points, seconds of the build, the ratio of the build's time to that of sphere points, and peak bytes per sphere of a small
render. The base, which is what the program takes without spheres, is
subtracted. --json FILE keeps the numbers. --isa avx2 limits the instruction set of orrery and of Embree.

--against renders with both programs in turns, on one thread, and prints the ratio of their user times, without what a
render of one sample takes: median over the rounds, least and greatest. Other work on the machine affects both.
"""
import argparse
import array
import json
import os
import pathlib
import random
import resource
import subprocess
import sys
import tempfile
from statistics import median

SCENE = """[camera]
look_from = [{look_from}]
look_at = [{look_at}]
vfov = 30
[background]
type = "constant"
color = [1, 1, 1]
[render]
sampler = "independent"
roulette_depth = 0
[material.white]
type = "lambertian"
albedo = [0.8, 0.8, 0.8]
[[points]]
file = "{file}"
radius = {radius}
material = "white"
"""
HEADER = """ply
format binary_little_endian 1.0
element vertex {count}
property float x
property float y
property float z
{more}end_header
"""
CHUNK = 1 << 20


def write(folder, name, count, chunks, radius, center, size):
    """Writes a PLY file and its scene. The radius is a number, or '{ column = "radius" }'."""
    more = "property float radius\n" if isinstance(radius, str) else ""
    with open(folder / (name + ".ply"), "wb") as out:
        out.write(HEADER.format(count=count, more=more).encode())
        for chunk in chunks:
            out.write(chunk)
    at = [center + size * x for x in (1.5, 1, 2)]
    scene = folder / (name + ".toml")
    scene.write_text(SCENE.format(look_from=", ".join(map(str, at)), look_at=", ".join([str(center)] * 3),
                                  file=name + ".ply", radius=radius))
    return scene


def uniform(folder, count):
    """Centres uniform in 1..2 on each axis: 23 random bits below the exponent of 1. The spheres fill 6.5 percent."""
    source = random.Random(1)

    def chunks():
        for begin in range(0, count, CHUNK):
            n = 3 * min(CHUNK, count - begin)
            bits = int.from_bytes(source.randbytes(4 * n), "little")
            mask = int.from_bytes(b"\xff\xff\x7f\x00" * n, "little")
            one = int.from_bytes(b"\x00\x00\x80\x3f" * n, "little")
            yield (bits & mask | one).to_bytes(4 * n, "little")

    return write(folder, f"uniform-{count}", count, chunks(), 0.0025 * (1e6 / count) ** (1 / 3), 1.5, 1)


def crystal(folder, count):
    """A face-centred cubic crystal of spheres that nearly touch, each off its place by 2 percent of the cell."""
    source = random.Random(1)
    cells = round((count / 4) ** (1 / 3))

    def chunks():
        for x in range(cells):
            row = array.array("f")
            for y in range(cells):
                for z in range(cells):
                    for dx, dy, dz in ((0, 0, 0), (0.5, 0.5, 0), (0.5, 0, 0.5), (0, 0.5, 0.5)):
                        row.extend((x + dx + source.gauss(0, 0.02), y + dy + source.gauss(0, 0.02),
                                    z + dz + source.gauss(0, 0.02)))
            yield row.tobytes()

    return write(folder, f"crystal-{count}", 4 * cells**3, chunks(), 0.3464, cells / 2, cells)


def with_radii(folder, name, count, radius_of):
    """Centres uniform in 1..2 on each axis, individual radii."""
    source = random.Random(1)

    def chunks():
        for begin in range(0, count, CHUNK):
            rows = array.array("f")
            for i in range(begin, min(count, begin + CHUNK)):
                rows.extend((1 + source.random(), 1 + source.random(), 1 + source.random(), radius_of(source, i)))
            yield rows.tobytes()

    return write(folder, f"{name}-{count}", count, chunks(), '{ column = "radius" }', 1.5, 1)


def stars(folder, count):
    """Radii from a lognormal distribution over about four decades: a few large spheres among many small ones."""
    typical = 0.0008 * (1e6 / count) ** (1 / 3)
    return with_radii(folder, "stars", count, lambda source, i: typical * source.lognormvariate(0, 1.2))


def grains(folder, count):
    """Radii from r to 100 r, with as much volume in each octave: most spheres are small."""
    least = 0.0006 * (1e6 / count) ** (1 / 3)
    return with_radii(folder, "grains", count, lambda source, i: least * (1 - source.random() * (1 - 1e-6)) ** (-1 / 3))


def giant(folder, count):
    """A uniform cloud, and one sphere of a hundred times their radius in its middle."""
    radius = 0.0025 * (1e6 / count) ** (1 / 3)
    return with_radii(folder, "giant", count, lambda source, i: 100 * radius if i == 0 else radius)


def capsids(folder, file):
    """Six copies of the first assembly of a PDB file, in two rows of three."""
    head, _ = SCENE.split("[[points]]")
    copies = "".join(f"""[[points]]
file = "{file.resolve()}"
assembly = "1"
material = "white"
radius.element = "vdw"
color.element = "jmol"
transform.translate = [{1950 * (i % 3)}, {1950 * (i // 3)}, 0]
""" for i in range(6))
    scene = folder / (file.stem + "-6.toml")
    scene.write_text(head.format(look_from="3800, -9500, 5200", look_at="1900, 950, 0") + copies)
    return scene


class Program:
    """The orrery executable, with an instruction set."""

    def __init__(self, path, isa):
        self.path, self.environment = path, {**os.environ, **({"ORRERY_ISA": isa} if isa else {})}

    def run(self, *words):
        return self.output_of(self.path, *words)

    def trace(self, *words):
        return self.output_of(pathlib.Path(self.path).resolve().parent.parent / "bench" / "bench_tracing", *words)

    def output_of(self, *words):
        return subprocess.run(words, check=True, capture_output=True, text=True, env=self.environment).stdout


def statistics(program, scene, folder, *options):
    stats = folder / "stats.json"
    program.run("render", scene, "-o", folder / "out.png", "-q", "--stats", stats, *options)
    return json.loads(stats.read_text())


def base_bytes(program, folder):
    scene = folder / "base.toml"
    scene.write_text('[background]\ntype = "constant"\n')
    return statistics(program, scene, folder, "--width", "64", "--height", "36", "--samples", "1")["peak_memory_bytes"]


def measure(program, scene, folder, rounds, base):
    bench = json.loads(program.run("bench", scene, "-q", "--json", "--rounds", str(rounds)))
    tracing = json.loads(program.trace(scene, str(rounds)))
    stats = statistics(program, scene, folder, "--width", "64", "--height", "36", "--samples", "1")
    hits = {t["name"]: t["rays_per_s"] for t in tracing["tracing"]}
    return {"scene": scene.stem, "spheres": stats["spheres"], "isa": bench["isa"],
            "paths_per_second": {c["name"]: c["paths_per_s"]["median"] for c in bench["cases"]},
            "hits_per_second": hits, "build_seconds": stats["seconds"]["build"],
            "build_ratio": next(b["relative_time"] for b in tracing["builds"] if b["name"] == "accelerator"),
            "bytes_per_sphere": (stats["peak_memory_bytes"] - base) / stats["spheres"]}


def user_seconds(program, scene, folder, precision, samples):
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    program.run("render", scene, "-o", folder / "out.exr", "-q", "-t", "1", "--width", "480", "--height", "270",
                "--precision", precision, "--samples", str(samples))
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def compare(program, other, scene, folder, rounds):
    """Prints the time of `program` relative to that of `other`."""
    for precision in ("fast", "exact"):
        starts = {p: min(user_seconds(p, scene, folder, precision, 1) for _ in range(2)) for p in (program, other)}
        ratios = []
        for i in range(rounds):
            turns = (program, other) if i % 2 else (other, program)
            took = {p: user_seconds(p, scene, folder, precision, 9) - starts[p] for p in turns}
            ratios.append(took[program] / took[other])
        print(f"{scene.stem:20} {precision:6} {median(ratios):.2f} ({min(ratios):.2f} .. {max(ratios):.2f})",
              flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--counts", default="1000000,10000000")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--whole", type=int, metavar="COUNT")
    parser.add_argument("--capsids", type=pathlib.Path, metavar="FILE", help="a PDB file, e.g. 1M4X.pdb")
    parser.add_argument("--radii", action="store_true", help="stars, grains and a cloud with a giant instead")
    parser.add_argument("--against", metavar="OTHER", help="another orrery executable")
    parser.add_argument("--isa", help="instruction set, e.g. avx2")
    parser.add_argument("--json")
    parser.add_argument("--folder", help="where the scenes are written; default: a temporary folder")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=options.folder) as name:
        folder = pathlib.Path(name)
        program = Program(options.program, options.isa)
        # A crystal of a billion would take hours to write.
        makers = (uniform, crystal) if (options.whole or 0) <= 200_000_000 else (uniform,)
        whole = [(make, options.whole) for make in makers if options.whole]
        if options.capsids:
            whole.append((capsids, options.capsids))
        for make, what in whole:
            scene = make(folder, what)
            out = statistics(program, scene, folder, "--width", "1920", "--height", "1080", "--samples", "16")
            keys = ("spheres", "seconds", "peak_memory_bytes", "traversal")
            print(json.dumps({"scene": scene.stem, **{k: out[k] for k in keys}}, indent=1), flush=True)
        if whole:
            return
        counts = [int(count) for count in options.counts.split(",")]
        makers = (stars, grains, giant) if options.radii else (uniform, crystal)
        if options.against:
            other = Program(options.against, options.isa)
            for count in counts:
                for make in makers:
                    compare(program, other, make(folder, count), folder, options.rounds)
            return
        base = base_bytes(program, folder)
        results = []
        print("scene                BVH: single  packets  one by one  sphere points   ratio    build  its ratio  "
              "bytes/sphere")
        for count in counts:
            for make in makers:
                r = measure(program, make(folder, count), folder, options.rounds, base)
                hits = {k: v / 1e6 for k, v in r["hits_per_second"].items()}
                own, other = (hits["single rays"], hits["packets"]), tuple(
                    next(v for k, v in hits.items() if k.endswith(", " + way)) for way in ("single", "packets"))
                is_bvh = "one by one, single" in hits
                bvh, one_by_one = (own, other) if is_bvh else (other, own)
                print(f"{r['scene']:20} {bvh[0]:9.2f} M {bvh[1]:6.2f} M {max(one_by_one):9.2f} M "
                      f"{hits['sphere points']:12.2f} M {max(own) / hits['sphere points']:7.2f} "
                      f"{r['build_seconds']:6.2f} s {r['build_ratio']:10.2f} {r['bytes_per_sphere']:13.0f}", flush=True)
                results.append(r)
        if options.json:
            pathlib.Path(options.json).write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    sys.exit(main())
