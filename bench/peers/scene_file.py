# SPDX-License-Identifier: Apache-2.0
"""Reads a scene file for export to other renderers, with all defaults filled in and material references resolved.

Supports what the book's final scene uses: [[sphere]] tables, lambertian, metal and dielectric materials, a gradient
sky. With `lights`, also emitters and a constant background. Anything else is an error, because a comparison must not
drop it silently.
"""

import math
import tomllib


class Unsupported(Exception):
    """The scene uses a feature that the exporters do not support."""


class Scene:
    def __init__(self, path, width, height, lights=False):
        with open(path, "rb") as file:
            data = tomllib.load(file)
        extra = set(data) - {"camera", "render", "material", "sphere", "image", "output"}
        if lights:
            extra -= {"background"}
        if extra:
            raise Unsupported(f"{path}: {', '.join(sorted(extra))}: not exported")
        camera = data.get("camera", {})
        self.width, self.height = width, height
        self.look_from = camera.get("look_from", [0, 0, 0])
        self.look_at = camera.get("look_at", [0, 0, -1])
        self.up = camera.get("up", [0, 1, 0])
        self.vfov = camera.get("vfov", 90)  # degrees
        self.focus_distance = camera.get("focus_distance", math.dist(self.look_from, self.look_at))
        self.lens_radius = self.focus_distance * math.tan(math.radians(camera.get("defocus_angle", 0)) / 2)
        self.max_depth = data.get("render", {}).get("max_depth", 50)
        self.sky_bottom, self.sky_top = [1.0, 1.0, 1.0], [0.5, 0.7, 1.0]
        if "background" in data:
            if data["background"].get("type") != "constant" or set(data["background"]) - {"type", "color"}:
                raise Unsupported(f"{path}: only a constant background is exported")
            self.sky_bottom = self.sky_top = data["background"]["color"]
        self.materials = {name: material(path, name, m, lights) for name, m in data["material"].items()}
        self.spheres = [(s["center"], s["radius"], s["material"]) for s in data["sphere"]]
        if any(radius < 0 for _, radius, _ in self.spheres):
            raise Unsupported(f"{path}: a negative radius: not exported")


def material(path, name, m, lights):
    if lights and m["type"] == "emitter":
        scale = 2.0 ** m.get("exposure", 0)
        return {"type": "emitter", "radiance": [scale * x for x in m["radiance"]]}
    if m["type"] not in ("lambertian", "metal", "dielectric"):
        raise Unsupported(f"{path}: material.{name}: {m['type']}: not exported")
    return {"type": m["type"], "albedo": m.get("albedo", [1, 1, 1]), "fuzz": m.get("fuzz", 0), "ior": m.get("ior", 1.5)}
