# SPDX-License-Identifier: Apache-2.0
"""Renders a scene file with Cycles from Blender's Python, and prints the rendering time in seconds.

    blender --background --factory-startup --python-exit-code 1 --python cycles.py -- \\
      SCENE.toml WxH SAMPLES THREADS OUT.exr [SEED]

Spheres become points of point clouds, which Cycles intersects as spheres. Each point is a separate point cloud, so
that it can have its own material. Emitters become point lights of the same radius and radiance: Cycles does not sample
emissive point clouds. The camera does not see them.
"""

import math
import os
import sys
import time

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from scene_file import Scene  # noqa: E402  (not on the search path of Blender's Python)


def z_up(v):
    """Converts from y-up to Blender's z-up coordinates."""
    return [v[0], -v[2], v[1]]


def make_material(name, m):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    shader = nodes.new({"lambertian": "ShaderNodeBsdfDiffuse", "metal": "ShaderNodeBsdfGlossy",
                        "dielectric": "ShaderNodeBsdfGlass"}[m["type"]])
    shader.inputs["Color"].default_value = [*m["albedo"], 1]
    if m["type"] == "metal":
        shader.inputs["Roughness"].default_value = m["fuzz"]
    if m["type"] == "dielectric":
        shader.inputs["IOR"].default_value = m["ior"]
        shader.inputs["Roughness"].default_value = 0
    links.new(shader.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return made


def make_points_group():
    """Geometry node group that converts vertices to points with a radius and a material."""
    group = bpy.data.node_groups.new("points", "GeometryNodeTree")
    group.inputs.new("NodeSocketGeometry", "Geometry")
    group.inputs.new("NodeSocketFloat", "Radius")
    group.inputs.new("NodeSocketMaterial", "Material")
    group.outputs.new("NodeSocketGeometry", "Geometry")
    source, sink = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    points, material = group.nodes.new("GeometryNodeMeshToPoints"), group.nodes.new("GeometryNodeSetMaterial")
    group.links.new(source.outputs[0], points.inputs["Mesh"])
    group.links.new(source.outputs[1], points.inputs["Radius"])
    group.links.new(points.outputs[0], material.inputs["Geometry"])
    group.links.new(source.outputs[2], material.inputs["Material"])
    group.links.new(material.outputs[0], sink.inputs[0])
    return group


def add_sphere(group, center, radius, material):
    mesh = bpy.data.meshes.new("point")
    mesh.from_pydata([(0, 0, 0)], [], [])
    thing = bpy.data.objects.new("point", mesh)
    thing.location = z_up(center)
    bpy.context.scene.collection.objects.link(thing)
    modifier = thing.modifiers.new("points", "NODES")
    modifier.node_group = group
    modifier[group.inputs[1].identifier] = float(radius)
    modifier[group.inputs[2].identifier] = material


def add_light(center, radius, radiance):
    """Adds a point light. Cycles divides its power by 4 pi and by the area of its disc."""
    data = bpy.data.lights.new("light", "POINT")
    data.shadow_soft_size = radius
    data.energy = 4 * math.pi**2 * radius**2
    data.color = radiance
    data.cycles.use_multiple_importance_sampling = True
    thing = bpy.data.objects.new("light", data)
    thing.location = z_up(center)
    bpy.context.scene.collection.objects.link(thing)


def make_sky(scene):
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    nodes.clear()
    where, split = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeSeparateXYZ")
    up, mix = nodes.new("ShaderNodeMapRange"), nodes.new("ShaderNodeMixRGB")
    light, out = nodes.new("ShaderNodeBackground"), nodes.new("ShaderNodeOutputWorld")
    up.inputs["From Min"].default_value = -1
    mix.inputs["Color1"].default_value = [*scene.sky_bottom, 1]
    mix.inputs["Color2"].default_value = [*scene.sky_top, 1]
    links.new(where.outputs["Generated"], split.inputs[0])
    links.new(split.outputs["Z"], up.inputs["Value"])
    links.new(up.outputs[0], mix.inputs["Fac"])
    links.new(mix.outputs[0], light.inputs["Color"])
    links.new(light.outputs[0], out.inputs["Surface"])
    # The book has no light sampling. For a sky with one map sample it is nearly free, but not entirely.
    world.cycles.sampling_method = "NONE"
    return world


def make_camera(scene):
    from mathutils import Matrix, Vector

    eye, at, up = (Vector(z_up(v)) for v in (scene.look_from, scene.look_at, scene.up))
    back = (eye - at).normalized()
    right = up.cross(back).normalized()
    data = bpy.data.cameras.new("camera")
    data.sensor_fit = "VERTICAL"
    data.angle = scene.vfov * 3.141592653589793 / 180
    if scene.lens_radius > 0:
        data.dof.use_dof = True
        data.dof.focus_distance = scene.focus_distance
        # f-number = focal length / aperture diameter. Blender's length unit is the metre; its lens is in millimetres.
        data.dof.aperture_fstop = data.lens / 1000 / (2 * scene.lens_radius)
    camera = bpy.data.objects.new("camera", data)
    camera.matrix_world = Matrix.Translation(eye) @ Matrix((right, back.cross(right), back)).transposed().to_4x4()
    bpy.context.scene.collection.objects.link(camera)
    return camera


def main(path, size, samples, threads, out, seed=0):
    width, height = map(int, size.split("x"))
    scene = Scene(path, width, height, lights=True)
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    materials = {name: make_material(name, m) for name, m in scene.materials.items() if m["type"] != "emitter"}
    group = make_points_group()
    for center, radius, name in scene.spheres:
        if name in materials:
            add_sphere(group, center, radius, materials[name])
        else:
            add_light(center, radius, scene.materials[name]["radiance"])

    target = bpy.context.scene
    target.world = make_sky(scene)
    target.camera = make_camera(scene)
    target.render.engine = "CYCLES"
    target.render.resolution_x, target.render.resolution_y = width, height
    target.render.resolution_percentage = 100
    target.render.threads_mode, target.render.threads = "FIXED", int(threads)
    target.render.image_settings.file_format = "OPEN_EXR"
    target.render.image_settings.color_depth = "32"
    target.render.filepath = out
    cycles = target.cycles
    cycles.device, cycles.samples, cycles.seed = "CPU", int(samples), int(seed)
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = scene.max_depth - 1
    cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    start = time.monotonic()
    bpy.ops.render.render(write_still=True)
    print(f"seconds {time.monotonic() - start:.3f}")


main(*sys.argv[sys.argv.index("--") + 1:])
