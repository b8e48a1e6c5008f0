#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the speed of orrery with OSPRay's path tracer at equal settings: one thread, independent samples, no light
sampling, no Russian roulette, up to 50 rays per path, a white sky.

    bench/peers/ospray.py build/src/orrery                         where libospray-dev and a C compiler are installed
    bench/peers/ospray.py build/src/orrery --root /srv/trixie      in a Debian 13 root made by debootstrap, as root

Scenes are the book's final scene, and the clouds and crystals of bench/many_spheres.py. Renderers take turns; the table
has the medians of all rounds in thousand paths per second. Building does not count; OSPRay's memory is not measured.
--keep FOLDER keeps the images.
"""
import argparse
import array
import json
import math
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]
import many_spheres  # noqa: E402
from scene_file import Scene  # noqa: E402

SETTINGS = ["--set", 'background.type="constant"', "--set", "background.color=[1, 1, 1]", "--set",
            'render.sampler="independent"', "--set", "render.roulette_depth=0", "--set", "render.max_depth=50"]
KINDS = {"lambertian": 0, "metal": 1, "dielectric": 2}


def numbers(*values):
    return " ".join(str(float(v)) for v in values)


def camera_text(look_from, look_at, up, vfov, lens_radius=0, focus_distance=1):
    return numbers(*look_from, *(a - b for a, b in zip(look_at, look_from)), *up, vfov, lens_radius, focus_distance)


class Final:
    """The book's final scene."""

    name, size, samples, scene = "final scene", (480, 270), 64, HERE.parent.parent / "scenes/book/final.toml"

    def ospray_text(self, folder, inside):
        s = Scene(self.scene, *self.size)
        names = list(s.materials)
        materials = [numbers(KINDS[m["type"]], *m["albedo"], m["ior"] if m["type"] == "dielectric" else m["fuzz"])
                     for m in s.materials.values()]
        bytes_ = array.array("f", [x for center, _, _ in s.spheres for x in center])
        bytes_.extend(radius for _, radius, _ in s.spheres)
        (folder / "final.bin").write_bytes(
            bytes_.tobytes() + array.array("I", [names.index(m) for _, _, m in s.spheres]).tobytes())
        return "\n".join([camera_text(s.look_from, s.look_at, s.up, s.vfov, s.lens_radius, s.focus_distance),
                          str(len(materials)), *materials, f"{len(s.spheres)} 0 {inside}/final.bin 0"])


class Many:
    """A scene of bench/many_spheres.py."""

    size, samples = (480, 270), 16

    def __init__(self, make, count, folder):
        self.scene = make(folder, count)
        self.name = self.scene.stem

    def ospray_text(self, folder, inside):
        text = self.scene.read_text()
        keys = {key: [float(x) for x in value.strip("[]").split(",")]
                for key, value in re.findall(r"^(look_from|look_at|vfov|radius|albedo) = (.*)$", text, re.M)}
        ply = self.scene.with_suffix(".ply")
        with open(ply, "rb") as file:
            head = file.read(4096)
        offset = head.index(b"end_header\n") + len(b"end_header\n")
        count = int(re.search(rb"element vertex (\d+)", head)[1])
        aligned = self.scene.with_suffix(".bin")  # OSPRay shares the array, which has to be aligned
        with open(ply, "rb") as source, open(aligned, "wb") as target:
            source.seek(offset)
            shutil.copyfileobj(source, target, 1 << 20)
        return "\n".join([camera_text(keys["look_from"], keys["look_at"], (0, 1, 0), keys["vfov"][0]), "1",
                          numbers(0, *keys["albedo"], 0),
                          f"{count} {keys['radius'][0]} {inside}/{aligned.name} 0"])


def run(*command):
    done = subprocess.run([str(c) for c in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False)
    if done.returncode != 0:
        sys.exit(f"ospray.py: error: {' '.join(str(c) for c in command)}\n{done.stdout[-2000:]}")
    return done.stdout


def orrery(options, scene, precision, folder):
    stats = folder / "stats.json"
    run(options.orrery, "render", scene.scene, "-o", folder / f"{scene.name}-{precision}.png", "-t", "1", "-q", "--stats",
        stats, "--width", scene.size[0], "--height", scene.size[1], "--samples", scene.samples, "--precision", precision,
        *SETTINGS)
    return json.loads(stats.read_text())["seconds"]["render"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("orrery", metavar="ORRERY", help="the orrery executable")
    parser.add_argument("--root", type=pathlib.Path, help="a Debian root with gcc and libospray-dev")
    parser.add_argument("--counts", default="1000000,10000000", help="of spheres, besides the final scene")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--keep", type=pathlib.Path, metavar="FOLDER")
    options = parser.parse_args()
    enter = ["chroot", options.root] if options.root else []
    with tempfile.TemporaryDirectory(dir=options.root / "tmp" if options.root else None) as name:
        folder = pathlib.Path(name)
        inside = "/" / folder.relative_to(options.root) if options.root else folder
        shutil.copy(HERE / "ospray.c", folder)
        run(*enter, "cc", "-O2", inside / "ospray.c", "-o", inside / "ospray", "-lospray")
        print(f"{'':18}{'fast':>10}{'exact':>10}{'OSPRay':>10}   fast / OSPRay   exact / OSPRay")
        makers = [Final]
        for count in map(int, filter(None, options.counts.split(","))):
            for make in (many_spheres.uniform, many_spheres.crystal):
                makers.append(lambda make=make, count=count: Many(make, count, folder))
        for maker in makers:
            scene = maker()
            text = scene.ospray_text(folder, inside)
            (folder / "scene.txt").write_text(numbers(*scene.size, scene.samples, 50) + "\n" + text + "\n")

            def ospray(scene=scene):
                output = run(*enter, inside / "ospray", inside / "scene.txt", inside / "ospray.ppm")
                shutil.copy(folder / "ospray.ppm", folder / f"{scene.name}-ospray.ppm")
                return float(re.search(r"^seconds ([0-9.]+)", output, re.M)[1])

            ways = {"fast": lambda s=scene: orrery(options, s, "fast", folder),
                    "exact": lambda s=scene: orrery(options, s, "exact", folder), "OSPRay": ospray}
            took = {way: [] for way in ways}
            for _ in range(options.rounds):
                for way, render in ways.items():
                    took[way].append(render())
            paths = math.prod(scene.size) * scene.samples
            ratio = {way: statistics.median(o / t for o, t in zip(took["OSPRay"], took[way])) for way in ("fast", "exact")}
            print(f"{scene.name:18}" + "".join(f"{paths / statistics.median(t) / 1e3:10.0f}" for t in took.values()) +
                  f"{ratio['fast']:16.2f}{ratio['exact']:18.2f}", flush=True)
            if options.keep:
                options.keep.mkdir(parents=True, exist_ok=True)
                for image in [*folder.glob("*.png"), *folder.glob("*-ospray.ppm")]:
                    shutil.copy(image, options.keep)
            for data in [*folder.glob("*.ply"), *folder.glob("*.bin")]:
                data.unlink()


if __name__ == "__main__":
    main()
