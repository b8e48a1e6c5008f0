# SPDX-License-Identifier: Apache-2.0
"""Checks how Blender reads our EXR files. Runs inside Blender: blender --background --python blender.py -- FOLDER.

FOLDER contains single.exr and multipart.exr, rendered from bunny.toml. Blender must find their layers under its own
names for passes, and its Cryptomatte node must select the sphere "bunny", and the beads of one group of a data file, with
the coverage computed from geometry.
"""
import math
import os
import sys

import bpy

FOLDER = sys.argv[sys.argv.index("--") + 1]
WIDTH, HEIGHT = 240, 160  # px, as in bunny.toml
DISTANCE, RADIUS, VFOV_DEG = 5.0, 1.0, 40.0
PIXELS_PER_TANGENT = HEIGHT / 2 / math.tan(math.radians(VFOV_DEG) / 2)


def area_px(aside, radius):
    """Area of a sphere's projection, an ellipse: its tangent cone intersected with the image plane. The sphere's centre is
    in the plane of the bunny's, `aside` from it."""
    distance = math.hypot(DISTANCE, aside)
    sine = radius / distance  # of half the cone's angle
    return (math.pi * (PIXELS_PER_TANGENT * sine) ** 2 * math.sqrt(1 - sine ** 2)
            / ((DISTANCE / distance) ** 2 - sine ** 2) ** 1.5)


OBJECTS = {"bunny": area_px(0, RADIUS), "beads.left": area_px(1.5, 0.3), "beads.right": area_px(1.5, 0.3)}

PASSES = {"Combined", "Depth", "N", "P", "albedo", "diffuse_direct", "diffuse_indirect", "variance", "samples",
          "object_id", "denoise.albedo", "CryptoObject00", "CryptoObject01", "CryptoObject02"}

failures = []


def expect(holds, what):
    if not holds:
        failures.append(what)


def composite(name, source):
    """Runs a compositor tree and returns the pixel values of the socket that `source(tree)` returns."""
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = WIDTH, HEIGHT, 100
    scene.use_nodes = True
    tree = scene.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("CompositorNodeOutputFile")
    output.base_path = FOLDER
    output.format.file_format = "OPEN_EXR"
    output.format.color_depth = "32"
    output.file_slots[0].path = name + "-"
    tree.links.new(source(tree), output.inputs[0])
    # Blender evaluates the tree only when it renders.
    bpy.ops.render.render()
    result = bpy.data.images.load(os.path.join(FOLDER, f"{name}-{scene.frame_current:04d}.exr"))
    values = list(result.pixels)
    bpy.data.images.remove(result)
    return values


def check(file):
    image = bpy.data.images.load(os.path.join(FOLDER, file))
    found = set()

    def image_node(tree):
        node = tree.nodes.new("CompositorNodeImage")
        node.image = image
        found.update(s.name for s in node.outputs)
        # Blender takes the text before the second-to-last dot as the layer; a node has the passes of one layer.
        other = tree.nodes.new("CompositorNodeImage")
        other.image = image
        other.layer = "denoise"
        found.update("denoise." + s.name for s in other.outputs)
        return node

    def matte(tree, name):
        node = tree.nodes.new("CompositorNodeCryptomatteV2")
        node.source = "IMAGE"
        node.image = image
        node.layer_name = "CryptoObject"
        node.matte_id = name
        return node.outputs["Matte"]

    def depth(tree):
        return image_node(tree).outputs["Depth"]

    values = composite(file + "-depth", depth)
    print(file, "passes:", sorted(found))
    middle = values[((HEIGHT // 2) * WIDTH + WIDTH // 2) * 4]
    expect(abs(middle - (DISTANCE - RADIUS)) < 1e-2, f"{file}: depth at the centre is {middle}")

    for name, area in OBJECTS.items():
        values = composite(f"{file}-{name}", lambda tree, name=name: matte(tree, name))
        coverage = sum(values[0::4])
        print(file, name, "coverage", coverage, "px, expected", area)
        expect(abs(coverage - area) < 0.002 * area, f"{file}: {name} covers {coverage} px, expected {area}")
        expect(max(values[0::4]) <= 1.0, f"{file}: matte value of {name} above 1")
        expect(values[0] == 0, f"{file}: the matte of {name} is {values[0]} in the corner, expected 0")
    missing = PASSES - found
    expect(not missing, f"{file}: Blender does not find {sorted(missing)} among {sorted(found)}")


for picture in ("single.exr", "multipart.exr"):
    check(picture)
for failure in failures:
    print("FAILED", failure)
print("blender.py:", "failed" if failures else "passed")
sys.exit(1 if failures else 0)
