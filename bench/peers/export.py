#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Converts a scene file to POV-Ray or Tachyon input, on standard output. docs/benchmarks.md lists the differences in
what the renderers compute.

    export.py pov SCENE.toml --size 480x270 --samples 16 > scene.pov
    export.py tachyon SCENE.toml --size 480x270 --samples 16 > scene.dat
"""

import argparse
import math
import sys

from scene_file import Scene, Unsupported


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def unit(a):
    length = math.hypot(*a)
    return [x / length for x in a]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def pov_vector(v):
    return "<" + ", ".join(f"{x:.9g}" for x in v) + ">"


def pov(scene, samples):
    """Right-handed through a negative `right` vector. The only light is the sky: one ambient term, no light source."""
    yield "#version 3.7;"
    yield f"global_settings {{ assumed_gamma 1.0 max_trace_level {scene.max_depth} }}"
    height = 2 * math.tan(math.radians(scene.vfov) / 2)
    forward = unit(sub(scene.look_at, scene.look_from))
    right = unit(cross(forward, scene.up))
    up = cross(right, forward)
    yield f"camera {{ perspective location {pov_vector(scene.look_from)} direction {pov_vector(forward)}"
    yield f"  right {pov_vector([x * height * scene.width / scene.height for x in right])}"
    yield f"  up {pov_vector([x * height for x in up])}"
    if scene.lens_radius > 0:
        # Variance 0 with full confidence never stops a pixel early, so every pixel gets the same number of rays.
        focus = [p + scene.focus_distance * f for p, f in zip(scene.look_from, forward)]
        yield f"  aperture {2 * scene.lens_radius:.9g} focal_point {pov_vector(focus)}"
        yield f"  blur_samples {samples}, {samples} confidence 0.999 variance 0"
    yield "}"
    yield "sky_sphere { pigment { gradient y color_map {"
    yield f"  [0 rgb {pov_vector(scene.sky_bottom)}] [1 rgb {pov_vector(scene.sky_top)}] }} scale 2 translate -y }} }}"
    for name, m in scene.materials.items():
        name = "m_" + name.replace("-", "_")
        color = pov_vector(m["albedo"])
        if m["type"] == "lambertian":
            text = f"pigment {{ rgb {color} }} finish {{ ambient 0.8 diffuse 0 }}"
        elif m["type"] == "metal":
            text = f"pigment {{ rgb {color} }} finish {{ ambient 0 diffuse 0 reflection {{ rgb {color} }} }}"
        else:
            text = "pigment { rgbf 1 } finish { ambient 0 diffuse 0 reflection { 0, 1 fresnel on } conserve_energy }"
        ior = f" interior {{ ior {m['ior']:.9g} }}" if m["type"] == "dielectric" else ""
        yield f"#declare {name} = material {{ texture {{ {text} }}{ior} }}"
    for center, radius, name in scene.spheres:
        yield f"sphere {{ {pov_vector(center)}, {radius:.9g} material {{ m_{name.replace('-', '_')} }} }}"


def tachyon(scene, samples):
    """No lens. The only light is the sky, through one ambient occlusion ray at each diffuse hit."""
    yield "BEGIN_SCENE"
    yield f"RESOLUTION {scene.width} {scene.height}"
    zoom = 1 / (2 * math.tan(math.radians(scene.vfov) / 2))
    yield f"CAMERA ZOOM {zoom:.9g} ASPECTRATIO 1.0 ANTIALIASING {samples - 1} RAYDEPTH {scene.max_depth}"
    # Tachyon is left-handed: negate z.
    flip = [1, 1, -1]
    at = [x * f for x, f in zip(scene.look_from, flip)]
    view = [x * f for x, f in zip(unit(sub(scene.look_at, scene.look_from)), flip)]
    yield f"CENTER {numbers(at)} VIEWDIR {numbers(view)} UPDIR {numbers(scene.up)} END_CAMERA"
    yield "SHADER_MODE full AMBIENT_OCCLUSION AMBIENT_COLOR 1 1 1 RESCALE_DIRECT 0.0 SAMPLES 1 END_SHADER_MODE"
    yield "BACKGROUND 0.75 0.85 1.0"
    for center, radius, name in scene.spheres:
        m = scene.materials[name]
        diffuse, specular, opacity = {"lambertian": (1, 0, 1), "metal": (0, 1, 1), "dielectric": (0, 0.1, 0.1)}[m["type"]]
        yield f"SPHERE CENTER {numbers([x * f for x, f in zip(center, flip)])} RAD {radius:.9g}"
        yield f"TEXTURE AMBIENT 0 DIFFUSE {diffuse} SPECULAR {specular} OPACITY {opacity}"
        yield f"COLOR {numbers(m['albedo'])} TEXFUNC 0"
    yield "END_SCENE"


def numbers(v):
    return " ".join(f"{x:.9g}" for x in v)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("format", choices=("pov", "tachyon"))
    parser.add_argument("scene", metavar="SCENE.toml")
    parser.add_argument("--size", default="480x270", metavar="WxH", help="image size, px")
    parser.add_argument("--samples", type=int, default=16, help="per pixel")
    options = parser.parse_args()
    width, height = map(int, options.size.split("x"))
    write = {"pov": pov, "tachyon": tachyon}[options.format]
    print("\n".join(write(Scene(options.scene, width, height), options.samples)))


if __name__ == "__main__":
    try:
        main()
    except (OSError, KeyError, ValueError, Unsupported) as error:
        print(f"export.py: error: {error}", file=sys.stderr)
        sys.exit(2)
