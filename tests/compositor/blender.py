# SPDX-License-Identifier: Apache-2.0
"""Checks how Blender reads our EXR files. Runs inside Blender: blender --background --python blender.py -- FOLDER.

FOLDER contains single.exr and multipart.exr, rendered from bunny.toml. Blender must find their layers under its own
names for passes, and its Cryptomatte node must select the sphere "bunny" with the coverage computed from geometry.
"""
import math
import os
import sys

import bpy

FOLDER = sys.argv[sys.argv.index("--") + 1]
WIDTH, HEIGHT = 240, 160  # px, as in bunny.toml
DISTANCE, RADIUS, VFOV_DEG = 5.0, 1.0, 40.0

# A sphere at the image centre projects to a circle: its tangent cone intersected with the image plane.
PIXELS_PER_TANGENT = HEIGHT / 2 / math.tan(math.radians(VFOV_DEG) / 2)
AREA_PX = math.pi * (PIXELS_PER_TANGENT * math.tan(math.asin(RADIUS / DISTANCE))) ** 2

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

    def matte(tree):
        node = tree.nodes.new("CompositorNodeCryptomatteV2")
        node.source = "IMAGE"
        node.image = image
        node.layer_name = "CryptoObject"
        node.matte_id = "bunny"
        return node.outputs["Matte"]

    def depth(tree):
        return image_node(tree).outputs["Depth"]

    values = composite(file + "-depth", depth)
    print(file, "passes:", sorted(found))
    middle = values[((HEIGHT // 2) * WIDTH + WIDTH // 2) * 4]
    expect(abs(middle - (DISTANCE - RADIUS)) < 1e-2, f"{file}: depth at the centre is {middle}")

    values = composite(file + "-matte", matte)
    coverage = sum(values[0::4])
    print(file, "coverage", coverage, "px, expected", AREA_PX)
    expect(abs(coverage - AREA_PX) < 0.002 * AREA_PX, f"{file}: the matte covers {coverage} px, expected {AREA_PX}")
    expect(max(values[0::4]) <= 1.0, f"{file}: matte value above 1")
    corner = values[0]
    expect(corner == 0, f"{file}: the matte is {corner} in the corner, expected 0")
    missing = PASSES - found
    expect(not missing, f"{file}: Blender does not find {sorted(missing)} among {sorted(found)}")


for picture in ("single.exr", "multipart.exr"):
    check(picture)
for failure in failures:
    print("FAILED", failure)
print("blender.py:", "failed" if failures else "passed")
sys.exit(1 if failures else 0)
