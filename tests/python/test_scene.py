# SPDX-License-Identifier: Apache-2.0
"""Scenes: the same bits and the same errors as the program; loading, saving and settings."""

import copy
import errno
import os
import pickle
import tracemalloc
import unittest
import warnings

import numpy as np
import orrery
from support import ROOT, SIZE, FolderTest, beauty, positions, run, small_scene

SCENE = """[image]
width = 40
height = 30
[render]
samples = 3
[output]
layers = ["Z", "N", "CryptoObject"]
[material.glass]
type = "dielectric"
[material.red]
type = "lambertian"
albedo = [0.8, 0.1, 0.1]
[[sphere]]
center = [0, 0, -1]
radius = 0.5
material = "glass"
[[sphere]]
center = [1, 0, -2]
radius = 0.7
material = "red"
name = "ball"
"""


def file_bytes(name):
    with open(name, "rb") as file:
        return file.read()


def write(name, text):
    with open(name, "w", encoding="utf-8") as file:
        file.write(text)


class FurtherRenders(unittest.TestCase):
    def test_they_have_the_bits_of_a_first_one(self):
        points = positions()
        scene = small_scene(points)

        def move():
            points[::7] += 0.25  # in place: the scene has the same array

        changes = [
            lambda: scene.set("render.seed", 7),
            lambda: scene.set("material.matte.albedo", [0.1, 0.9, 0.2]),
            move,
            lambda: scene.set("render.precision", "fast"),
            lambda: scene.add_sphere((0, 0, 3), 0.5),
            lambda: scene.set("sphere[0].radius", 0.4),
            lambda: scene.set("camera.vfov", 20),
            lambda: scene.add_points(positions(20, 2), radius=0.2),
            move,
        ]
        first = beauty(scene)
        self.assertEqual(beauty(scene), first)
        for change in changes:
            change()
            self.assertEqual(beauty(scene), beauty(copy.deepcopy(scene)))
        self.assertNotEqual(beauty(scene), first)

    def test_nothing_is_built_again_without_need(self):
        scene = small_scene(positions())
        self.assertGreater(scene.render(*SIZE).statistics["build_seconds"], 0)
        scene.set("material.matte.albedo", [0.5, 0.1, 0.1])
        self.assertEqual(scene.render(*SIZE).statistics["build_seconds"], 0)
        self.assertEqual(beauty(scene), beauty(pickle.loads(pickle.dumps(scene))))

    def test_a_copy_is_a_scene_of_its_own(self):
        scene = small_scene(positions())
        wanted = beauty(scene)
        other = copy.copy(scene)
        self.assertEqual(beauty(other), wanted)
        other.add_sphere((0, 0, 0), 2)
        other.set("camera.vfov", 20)
        self.assertNotEqual(beauty(other), wanted)
        self.assertEqual(beauty(scene), wanted)

    def test_a_render_may_start_in_on_progress(self):
        scene = small_scene(positions())
        pictures = []

        def report(_):
            if not pictures:
                pictures.append(None)
                pictures.append(beauty(scene))

        self.assertEqual(scene.render(*SIZE, threads=2, on_progress=report).beauty.tobytes(), pictures[1])


class CameraObjects(unittest.TestCase):
    def test_a_fitted_camera_is_copied_and_pickled(self):
        scene = small_scene(positions())
        scene.set("camera", orrery.Camera.fit(positions(), 0.2, look_from="+x"))
        self.assertNotEqual(beauty(scene), beauty(small_scene(positions())))
        wanted = beauty(scene)
        for other in (copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
            self.assertEqual(beauty(other), wanted)

    def test_arguments_of_fit_are_checked(self):
        with self.assertRaises(orrery.Error):
            orrery.Camera.fit(positions(), up="w")
        for radius in (-1, float("nan"), float("inf")):
            with self.assertRaisesRegex(ValueError, "radius"):
                orrery.Camera.fit(positions(), radius)
        self.assertGreater(orrery.Camera.fit([[1, 2, 3]]).keys["width"], 0)


class Arguments(unittest.TestCase):
    def test_whole_numbers(self):
        scene = small_scene(positions())
        for key in ("width", "height", "samples", "threads", "frame"):
            for value in (1.5, "32"):
                with self.subTest(key=key, value=value), self.assertRaisesRegex(TypeError, key):
                    scene.render(**{key: value})
        scene.render(np.int64(8), np.int32(8), threads=np.uint8(1))

    def test_points_that_are_refused_leave_no_arrays(self):
        scene = orrery.Scene()
        before = repr(scene)
        with self.assertRaises(TypeError):
            scene.add_points(positions(), 1, select=object())
        self.assertEqual(repr(scene), before)


class Changes(FolderTest):
    """A call that fails leaves the scene as it was, and its message names only what the user wrote."""

    def test_points_that_are_refused(self):
        scene = small_scene(positions())
        wanted = beauty(scene)
        for keys, text in (
            ({"selct": "x > 0"}, r"^add_points\(\): error: unknown key `selct`; did you mean `select`\?\n"),
            ({"select": "x > 0 && q < 1"}, r"^add_points\(\): error: select: at character 10: unknown column q;"),
            ({"color": {"column": "speed"}}, r"^add_points\(\): error: color.column: the file has no column `speed`"),
            ({"color": {"column": "x", "map": "virids"}}, "there is no colour map \"virids\"; did you mean `viridis`"),
            ({"radius": -1}, "radius is -1"),
            ({"transform": {"scale": 0}}, "transform.scale is 0"),
            ({"material": 5}, "material must be a string"),
        ):
            with self.subTest(keys=keys), self.assertRaisesRegex(orrery.SceneError, text):
                scene.add_points(positions(), **{"radius": 0.1, **keys})
        with self.assertRaisesRegex(TypeError, "'file'"):
            scene.add_points(positions(), 0.1, file="a.ply")
        self.assertEqual(beauty(scene), wanted)

    def test_spheres_that_are_refused(self):
        scene = small_scene(positions())
        wanted = beauty(scene)
        for arguments, text in (
            (((0, 0, 0), 0), r"^add_sphere\(\): error: radius: radius is 0"),
            (((0, 0), 1), "center must be three numbers"),
            (((0, 0, float("nan")), 1), r"center\[2\] is nan"),
            (((0, 0, 0), "1"), "radius must be a number"),
            (((0, 0, 0), 1, 5), "material must be a string"),
            ((5, 1), "center must be three numbers"),
        ):
            with self.subTest(arguments=arguments), self.assertRaisesRegex(orrery.SceneError, text):
                scene.add_sphere(*arguments)
        with self.assertRaises(TypeError):
            scene.add_sphere((0, 0, object()), 1)
        self.assertEqual(beauty(scene), wanted)

    def test_rods(self):
        scene = small_scene(positions())
        without = beauty(scene)
        for arguments, text in (
            (((0, 0, 0), (1, 0, 0), 0), r"^add_rod\(\): error: radius is 0; must be in"),
            (((0, 0), (1, 0, 0), 1), "from must be three numbers"),
            (((0, 0, 0), (0, 0, float("nan")), 1), r"to\[2\] is nan"),
            (((0, 0, 0), (1, 0, 0), 1, 5), "material must be a string"),
            (((0, 0, 0), (1, 0, 0), 1, ("a", "b", "c")), "material has 3 names"),
        ):
            with self.subTest(arguments=arguments), self.assertRaisesRegex(orrery.SceneError, text):
                scene.add_rod(*arguments)
        self.assertEqual(beauty(scene), without)
        scene.add_material("glass", orrery.Dielectric(1.5))
        scene.add_rod((0, 0, 0), (1, 0, 0), 0.2, ("matte", "glass"))
        with self.assertRaisesRegex(orrery.SceneError, "\"glass\" is a dielectric, but rods transmit no light"):
            scene.check()
        scene.add_material("glass", orrery.Metal(0.5))
        self.assertNotEqual(beauty(scene), without)

    def test_a_material_may_be_added_later(self):
        scene = small_scene(positions(), material="gold")
        with self.assertRaisesRegex(orrery.SceneError, r"^scene: error: points\[0\].material is \"gold\", which is not defined"):
            scene.check()
        scene.add_material("gold", orrery.Metal(0.5))
        self.assertEqual(scene.check(), [])

    def test_lines_are_those_of_the_scene_file(self):
        write("scene.toml", SCENE.replace("radius = 0.5", "radius = 0"))
        scene = orrery.load("scene.toml")
        scene.add_sphere((0, 0, 0), 1, "gold")
        with self.assertRaises(orrery.SceneError) as caught:
            scene.check()
        line = SCENE[: SCENE.index("radius = 0.5")].count("\n") + 1
        self.assertIn(f"scene.toml:{line}:", str(caught.exception))
        self.assertIn("scene.toml: error: sphere[2].material is \"gold\"", str(caught.exception))

    def test_none_removes_a_setting(self):
        scene = small_scene(positions())
        wanted = beauty(scene)
        scene.set("camera.vfow", 30)
        scene.set("background", orrery.Sky(20))
        scene.set("background.turbidity", 3)
        self.assertRaises(orrery.SceneError, scene.check)
        scene.set("camera.vfow", None)
        scene.set("background", None)
        scene.set("camera.none", None)
        scene.set("background", orrery.Gradient())
        self.assertEqual(beauty(scene), wanted)

    def test_the_cost_of_a_change_does_not_grow_with_the_scene(self):
        scene = orrery.Scene()
        for i in range(5000):
            scene.add_sphere((i, 0, 0), 0.3)
            scene.set(f"sphere[{i}].radius", 0.2)
        self.assertEqual(scene.check(), [])

        class Settings(dict):
            __iter__ = None  # nothing looks at all settings

        scene._settings = Settings(scene._settings)
        tracemalloc.start()
        try:
            scene.add_sphere((0, 1, 0), 0.3)
            scene.add_points(positions(), 0.1)
            scene.add_material("gold", orrery.Metal(0.5))
            self.assertLess(tracemalloc.get_traced_memory()[1], 50_000)  # nothing copies the text of all spheres
        finally:
            tracemalloc.stop()


class Messages(FolderTest):
    def test_wrong_arguments_are_named(self):
        """No message shows the C++ functions behind the package."""
        p, scene = positions(), small_scene(positions())
        picture = scene.render(4, 4, samples=1)
        wrong = (object(), 5, 1.5, -1, 2**70, float("nan"), "a\0b", "\ud800", b"\xff", None, True, [], {}, (1, 2, 3), ["a"])
        calls = [
            lambda v: orrery.Camera.fit(v),
            lambda v: orrery.Camera.fit(p, v),
            lambda v: orrery.Camera.fit(p, look_from=v),
            lambda v: orrery.Camera.fit(p, up=v),
            lambda v: orrery.Camera.fit(p).keys_for(v),
            lambda v: orrery.Camera.fit(p).keys_for(1, v),
            lambda v: orrery.Camera.fit(p).keys_for(1, 1, v),
            lambda v: orrery.load(v),
            lambda v: orrery.read_points(v),
            lambda v: orrery.read_points("none.csv", frame=v),
            lambda v: orrery.read_points("none.csv", component=v),
            lambda v: orrery.read_points("none.csv", columns=v),
            lambda v: orrery.read_points("none.csv", topology=v),
            lambda v: orrery.colormap(v),
            lambda v: orrery.colormap(p[:, 0], v),
            lambda v: orrery.colormap(p[:, 0], range=v),
            lambda v: orrery.colormap(p[:, 0], nan_color=v),
            lambda v: small_scene(p).set(v, 1),
            lambda v: small_scene(p).set("camera.vfov", v),
            lambda v: small_scene(p).add_material(v, v),
            lambda v: small_scene(p).add_sphere(v, 1),
            lambda v: small_scene(p).add_sphere((0, 0, 0), v, v, name=v, group=v),
            lambda v: small_scene(p).add_rod(v, v, v, v, name=v, group=v),
            lambda v: small_scene(v),
            lambda v: small_scene(p, radius=v),
            lambda v: small_scene(p, color=v),
            lambda v: small_scene(p, material=v),
            lambda v: small_scene(p, columns=v),
            lambda v: small_scene(p, columns={v: p[:, 0]}),
            lambda v: small_scene(p, columns={"a": v}),
            lambda v: small_scene(p, select=v, clip=v, name=v),
            lambda v: small_scene(p).save(v),
            lambda v: orrery.Scene(v, v, {"m": v}).check(),
            lambda v: scene.render(v, 4, samples=1),
            lambda v: scene.render(4, 4, samples=v and 1, frame=v),
            lambda v: scene.render(4, 4, samples=1, threads=v),
            lambda v: scene.render(4, 4, samples=1, noise=v and 1, time=v and 0.01),
            lambda v: scene.render(4, 4, samples=1, on_progress=v),
            lambda v: picture[v],
            lambda v: picture.write(v),
            lambda v: picture.write("a.exr", compression=v),
            lambda v: picture.write("a.exr", type=v),
            lambda v: picture.write("a.png", bits=v),
            lambda v: picture.to_srgb8(display=v),
            lambda v: picture.to_srgb8(view=v),
            lambda v: picture.to_srgb8(look=v),
            lambda v: picture.to_srgb8(exposure=v),
        ]
        raised = 0
        for number, call in enumerate(calls):
            for value in wrong:
                with self.subTest(call=number, value=value), warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    try:
                        call(value)
                    except (orrery.Error, TypeError, ValueError, KeyError, OSError) as error:
                        raised += 1
                        self.assertNotRegex(str(error), r"incompatible|_orrery|std::|Invoked with|internal")
        self.assertGreater(raised, len(calls) * len(wrong) // 2)

    def test_a_data_file_is_no_scene(self):
        write("water.xyz", "1\n\nO 0 0 0\n")
        with self.assertRaisesRegex(orrery.UsageError, "is a data file, not a scene"):
            orrery.load("water.xyz")

    def test_errors_of_the_system_have_number_and_file(self):
        write("points.toml", SCENE + '[[points]]\nfile = "none.ply"\nmaterial = "red"\n')
        os.mkdir("folder.toml")
        picture = small_scene(positions()).render(4, 4, samples=1)
        for kind, number, file, call in (
            (FileNotFoundError, errno.ENOENT, "none.toml", lambda: orrery.load("none.toml")),
            (FileNotFoundError, errno.EISDIR, "folder.toml", lambda: orrery.load("folder.toml")),
            (FileNotFoundError, errno.ENOENT, "none.csv", lambda: orrery.read_points("none.csv")),
            (FileNotFoundError, errno.ENOENT, "none.ply", lambda: orrery.load("points.toml").check()),
            (OSError, errno.ENOENT, "none/a.exr", lambda: picture.write("none/a.exr")),
            (OSError, errno.ENOENT, "none/a.toml", lambda: small_scene(positions()).save("none/a.toml")),
        ):
            with self.subTest(file=file), self.assertRaises(kind) as caught:
                call()
            error = caught.exception
            self.assertEqual((error.errno, error.filename, error.strerror), (number, file, os.strerror(number)))
            self.assertIn(file, str(error))
            self.assertNotIn("[Errno", str(error))
            self.assertEqual(str(pickle.loads(pickle.dumps(error))), str(error))


class Encodings(FolderTest):
    def test_bytes_that_are_not_utf8_are_replaced(self):
        with open("a.xyz", "wb") as file:
            file.write(b"1\nlength in \xc5\nAr 1 2 3\n")
        self.assertEqual(orrery.read_points("a.xyz").title, "length in \ufffd")
        with open("a.csv", "wb") as file:
            file.write(b"x,y,z,caf\xe9\n1,2,3,\xe9t\xe9\n")
        self.assertEqual(list(orrery.read_points("a.csv")["caf\ufffd"]), ["\ufffdt\ufffd"])
        os.mkdir(b"d\xe9")
        with self.assertRaisesRegex(orrery.Error, "no_such"):
            orrery.read_points(os.path.join(os.fsdecode(b"d\xe9"), "no_such.csv"))


class SameAsTheProgram(FolderTest):
    def test_files_of_a_scene_file(self):
        write("scene.toml", SCENE)
        for options, keys in (([], {}), (["--noise", "0.2"], {"noise": 0.2}), (["--samples", "5"], {"samples": 5})):
            with self.subTest(options=options):
                status, error = run("render", "scene.toml", "-o", "a.exr", "-q", "--reproducible", *options)
                self.assertEqual(status, 0, error)
                orrery.load("scene.toml").render(**keys).write("b.exr", reproducible=True)
                self.assertEqual(file_bytes("a.exr"), file_bytes("b.exr"))

    def test_denoised_images(self):
        write("scene.toml", SCENE.replace('"CryptoObject"', '"diffuse", "specular"').replace("samples = 3", "samples = 16"))
        status, error = run("render", "scene.toml", "-o", "a.exr", "-o", "a.png", "-q", "--reproducible", "--denoise")
        self.assertEqual(status, 0, error)
        scene = orrery.load("scene.toml")
        clean = scene.render(denoise=True, threads=1)
        clean.write("b.exr", "b.png", reproducible=True)
        for extension in ("exr", "png"):
            self.assertEqual(file_bytes(f"a.{extension}"), file_bytes(f"b.{extension}"))
        self.assertFalse((clean.beauty == scene.render().beauty).all())
        self.assertNotIn("halves", clean.layers)
        self.assertGreater(clean.statistics["denoise_seconds"], 0)

    def test_images_of_all_formats(self):
        write("scene.toml", SCENE.replace('layers = ["Z", "N", "CryptoObject"]', ""))
        picture = orrery.load("scene.toml").render()
        for name in ("a.png", "a.jpg", "a.tif", "a.hdr", "a.ppm"):
            status, error = run("render", "scene.toml", "-o", name, "-q")
            self.assertEqual(status, 0, error)
            picture.write("b" + name)
            self.assertEqual(file_bytes(name), file_bytes("b" + name), name)

    def test_a_scene_of_arrays_that_was_saved(self):
        random = np.random.default_rng(2)
        p = random.normal(size=(80, 3))
        single, double = np.float32, np.float64
        for dtype, color in (
            (double, None),
            (single, orrery.colormap(p[:, 1], "magma", range=(-1, 1))),
            (double, random.random((80, 3))),
            (single, (1, 0, 0)),
        ):
            scene = small_scene(p.astype(dtype), radius=random.random(80) / 3 + 0.1, color=color, name="cloud")
            scene.add_points(p + 1, radius=0.1, material="gold")
            scene.add_material("gold", orrery.Metal((0.8, 0.6, 0.2), 0.1))
            scene.add_sphere((0, 0, -101), 100, name="ground \u00e9")
            scene.set("output.layers", ["Z", "CryptoObject"])
            scene.set("image.width", SIZE[0])
            scene.set("image.height", SIZE[1])
            scene.save("saved.toml")
            picture = scene.render()
            status, error = run("render", "saved.toml", "-o", "a.exr", "-q", "--type", "float")
            self.assertEqual(status, 0, error)
            picture.write("b.exr", type="float")
            loaded = orrery.load("saved.toml").render()
            for layer in picture.layers:
                np.testing.assert_array_equal(picture[layer], loaded[layer])
            self.assertEqual(picture.beauty.tobytes(), loaded.beauty.tobytes())
            status, error = run("compare", "a.exr", "b.exr", "--fail-above", "max=0")
            self.assertEqual(status, 0, error)

    def test_errors_have_the_same_text(self):
        write("bad.toml", SCENE.replace("radius = 0.5", "radis = 0.5").replace("samples = 3", "samples = 0"))
        write("worse.toml", "[image\n")
        write("points.toml", SCENE + '[[points]]\nfile = "none.ply"\nmaterial = "red"\n')
        write("scene.toml", SCENE)
        for file, setting, kind in (
            ("bad.toml", None, orrery.SceneError),
            ("worse.toml", None, orrery.SceneError),
            ("none.toml", None, orrery.MissingInputError),
            ("points.toml", None, orrery.MissingInputError),
            ("scene.toml", ("camera.vfov", 300), orrery.SceneError),
            ("scene.toml", ("camera.vfow", 30), orrery.SceneError),
            ("scene.toml", ("color.view", "none"), orrery.SceneError),
            ("scene.toml", ("sphere[7].radius", 1), orrery.SceneError),
        ):
            with self.subTest(file=file, setting=setting):
                with self.assertRaises(kind) as caught:
                    scene = orrery.load(file)
                    if setting:
                        scene.set(*setting)
                    scene.render()
                options = ["--set", f"{setting[0]}={orrery._keys.toml_text(setting[1])}"] if setting else []
                status, error = run("render", file, "-o", "a.exr", "-q", *options)
                self.assertEqual(str(caught.exception), error.replace("orrery: ", "").rstrip("\n"))
                self.assertEqual(caught.exception.exit_status, status)

    def test_warnings_have_the_same_text(self):
        write("scene.toml", SCENE + "[background]\nrotation = 5\n")
        with self.assertWarns(orrery.SceneWarning) as caught:
            orrery.load("scene.toml").render()
        status, error = run("check", "scene.toml")
        self.assertEqual(status, 0)
        self.assertIn(str(caught.warning), error)
        self.assertEqual(orrery.load("scene.toml").check()[0].rstrip("\n"), str(caught.warning))


class Settings(FolderTest):
    def test_the_last_setting_wins(self):
        write("scene.toml", SCENE)
        scene = orrery.load("scene.toml")
        scene.set("image.width", 8)
        scene.set("image.width", 16)
        self.assertEqual(scene.render().width, 16)
        self.assertEqual(scene.render(24).width, 24)
        self.assertEqual(scene.render().width, 16)

    def test_a_table_replaces_all_keys_of_its_name(self):
        scene = orrery.Scene(background=orrery.Sky(30))
        scene.set("background.turbidity", 3)
        scene.set("background", orrery.Constant(0.25))
        self.assertEqual(scene.check(), [])
        picture = scene.render(8, 8, samples=1)
        np.testing.assert_array_equal(picture.beauty[..., :3], np.float32(0.25))

    def test_materials_and_backgrounds(self):
        backgrounds = [orrery.Constant((1, 0, 0)), orrery.Gradient(0, (0, 0, 1)), orrery.Sky(20, 90, turbidity=3)]
        materials = [
            orrery.Lambertian(0.5),
            orrery.Hemisphere((0.5, 0.5, 0.5)),
            orrery.Metal(0.5, 0.1),
            orrery.Dielectric(1.3, fresnel="exact"),
            orrery.Emitter(2, light_group="lamp"),
            orrery.Plastic((0.2, 0.5, 0.5), ior=1.6, fuzz=0.1),
        ]
        for background in backgrounds:
            images = set()
            for material in materials:
                scene = orrery.Scene(background=background, materials={"my material": material})
                scene.add_sphere((0, 0, -2), 1, "my material")
                images.add(scene.render(12, 12, samples=2).beauty.tobytes())
            self.assertGreaterEqual(len(images), 3)  # under a constant sky, what reflects half of it looks the same
        orrery.Scene(background=orrery.Constant(1)).render(8, 4).write("map.hdr")
        image = orrery.Scene(background=orrery.Image("map.hdr", exposure=1)).render(4, 4, samples=1)
        np.testing.assert_allclose(image.beauty[..., :3], 2, rtol=0.01)

    def test_textures(self):
        orrery.Scene(background=orrery.Gradient()).render(8, 4, samples=1).write("map.png")
        number = {"texture": "checker", "scale": 0.3, "even": 0, "odd": 0.5}
        color = {"texture": "checker", "scale": 0.3, "even": (0.1, 0.2, 0.3), "odd": np.full(3, 0.9)}
        image = {"texture": "image", "file": "map.png"}
        text = '{ texture = "checker", scale = 0.3, even = [0.1, 0.2, 0.3], odd = [0.9, 0.9, 0.9] }'
        images = set()
        materials = [
            orrery.Lambertian(color),
            orrery.Lambertian(image),
            orrery.Hemisphere(color),
            orrery.Metal(color, number),
            orrery.Dielectric(1.5, fuzz=number),
            orrery.Emitter({"texture": "marble", "scale": 4}),
            orrery.Plastic(color, fuzz=number),
        ]
        for material in materials:
            scene = orrery.Scene(background=orrery.Gradient(), materials={"textured": material})
            scene.add_sphere((0, 0, -2), 1, "textured")
            scene.set("render.samples", 4)
            images.add(beauty(scene))
        self.assertEqual(len(images), len(materials))
        orrery.Scene().save("scene.toml")
        with open("scene.toml", "a", encoding="utf-8") as file:
            file.write('[background]\ntype = "gradient"\n[render]\nsamples = 4\n[[sphere]]\ncenter = [0, 0, -2]\n'
                       f'radius = 1\nmaterial = "textured"\n[material.textured]\ntype = "lambertian"\nalbedo = {text}\n')
        self.assertIn(beauty(orrery.load("scene.toml")), images)

    def test_values(self):
        text = orrery._keys.toml_text
        self.assertEqual(text(True), "true")
        self.assertEqual(text(np.float32(0.5)), "0.5")
        self.assertEqual(text(np.arange(3)), "[0, 1, 2]")
        self.assertEqual(text({"a b": (1, 2.5)}), '{"a b" = [1, 2.5]}')
        self.assertEqual(text('say "hi"\n'), '"say \\"hi\\"\\n"')
        self.assertRaises(TypeError, text, object())
        self.assertRaises(TypeError, text, 1j)

    def test_limits(self):
        scene = orrery.Scene()
        for keys in ({"noise": 0}, {"noise": 2}, {"time": -1}, {"threads": 0}, {"memory_limit": "8G"}):
            with self.assertRaisesRegex(ValueError, next(iter(keys))):
                scene.render(4, 4, **keys)
        with self.assertRaisesRegex(orrery.OutOfMemoryError, "and memory_limit allows 1.0 KiB; raise the limit"):
            scene.render(400, 400, memory_limit=1000)
        with self.assertRaises(MemoryError):
            scene.render(400, 400, memory_limit=1000)


class Cameras(FolderTest):
    def fitted(self, radius=0.3, **keys):
        """A scene with a fitted camera."""
        p = positions() * (3, 1, 1)
        scene = orrery.Scene(camera=orrery.Camera.fit(p, radius, **keys), background=orrery.Constant(1, alpha=0))
        scene.add_points(p, radius=0.3)
        return scene

    def expect_fit(self, scene, *size):
        """Nothing is cut off, and the spheres fill the image in one direction."""
        alpha = scene.render(*size, samples=4).beauty[..., 3] > 0
        height, width = alpha.shape
        rows, columns = np.flatnonzero(alpha.any(axis=1)), np.flatnonzero(alpha.any(axis=0))
        margins = rows[0], height - 1 - rows[-1], columns[0], width - 1 - columns[-1]
        self.assertGreater(min(margins), 0, margins)
        self.assertLess(min(min(margins[:2]) / height, min(margins[2:]) / width), 0.12, margins)

    def test_a_fitted_camera_sees_everything_at_any_size(self):
        for size in ((160, 90), (90, 160), (200, 40)):
            for look_from in ("iso", "+x", "-y", "30,20"):
                with self.subTest(size=size, look_from=look_from):
                    self.expect_fit(self.fitted(look_from=look_from), *size)

    def test_image_sizes_of_the_scene(self):
        scene = self.fitted()
        scene.set("image", {"width": 400, "height": 40})
        self.expect_fit(scene)
        scene.set("image.height", 300)
        self.expect_fit(scene)
        scene.set("image", {"pixel_aspect": 2})  # and the default size
        self.expect_fit(scene, 160, 90)
        for pixel_aspect in (0.25, 3):
            scene = self.fitted()
            scene.set("image.pixel_aspect", pixel_aspect)
            self.expect_fit(scene, 160, 90)
        for image in (7, "no table", {"width": "wide"}, {"width": -1}):
            scene.set("image", image)
            with self.assertRaises(orrery.SceneError):
                scene.render()

    def test_the_radius_is_completed_by_that_of_the_points(self):
        explicit, completed = self.fitted(), self.fitted(None)
        self.assertEqual(beauty(explicit), beauty(completed))
        completed.save("completed.toml")
        self.assertEqual(beauty(orrery.load("completed.toml")), beauty(explicit))
        p = positions() * (3, 1, 1)
        for keys in (
            {"radius": np.linspace(0.1, 1.4, len(p))},
            {"radius": {"column": "size", "scale": 0.7}, "columns": {"size": np.full(len(p), 2)}},
            {"columns": {"diameter": np.full(len(p), 2.8)}},
            {"radius": 0.1, "transform": {"scale": 1.5}},
            {"radius": 1.4},
        ):
            with self.subTest(keys=keys):
                scene = orrery.Scene(camera=orrery.Camera.fit(p * keys.get("transform", {}).get("scale", 1)))
                scene.set("background", orrery.Constant(1, alpha=0))
                scene.add_points(p, **keys)
                scene.add_sphere((0, 0, 0), 1e-3)
                self.expect_fit(scene, 160, 90)
        scene.set("points[0].radius", 3)
        self.expect_fit(scene, 160, 90)
        self.assertNotEqual(beauty(self.fitted(0.0)), beauty(explicit))

    def test_errors_of_points_are_those_of_the_render(self):
        scene = orrery.Scene(camera=orrery.Camera.fit(positions()))
        radii = np.zeros(len(positions()))
        scene.add_points(positions(), radius=radii)
        for radii[0] in (0, float("nan")):
            with self.subTest(radius=radii[0]), self.assertRaisesRegex(orrery.SceneError, "radius"):
                scene.render(8, 8, samples=1)

    def test_a_field_of_view_makes_a_fitted_camera_perspective(self):
        for vfov in (5, 30, 100):
            for size in ((160, 90), (90, 160), (200, 40)):
                scene = self.fitted(None)
                scene.set("camera.vfov", vfov)
                with self.subTest(vfov=vfov, size=size):
                    self.assertEqual(scene.check(), [])
                    alpha = scene.render(*size, samples=4).beauty[..., 3]
                    border = np.concatenate([alpha[0], alpha[-1], alpha[:, 0], alpha[:, -1]])
                    self.assertEqual(border.max(), 0)
                    self.assertGreater(alpha.mean(), {5: 0.02, 30: 0.015, 100: 0.001}[vfov])
        self.assertNotEqual(beauty(scene), beauty(self.fitted()))
        scene.set("camera.vfov", 300)
        with self.assertRaisesRegex(orrery.SceneError, "vfov"):
            scene.render(8, 8)

    def test_bad_views(self):
        with self.assertRaisesRegex(orrery.UsageError, "is not a view"):
            orrery.Camera.fit(positions(), look_from="above")
        with self.assertRaises(ValueError):
            orrery.Camera.fit(np.zeros((3, 2)))

    def test_positions_that_are_not_finite(self):
        p = positions()
        p[7, 1] = np.nan
        with self.assertRaisesRegex(orrery.SceneError, r"row 8 of positions is not finite"):
            orrery.Camera.fit(p)

    def test_no_positions(self):
        orrery.Scene(camera=orrery.Camera.fit(np.zeros((0, 3)))).render(4, 4, samples=1)


class Files(FolderTest):
    def test_saving_keeps_files_of_other_folders(self):
        os.mkdir("in")
        os.mkdir("out")
        small = orrery.Scene()
        small.add_points(positions(), radius=0.3)
        small.save("in/scene.toml")
        scene = orrery.load("in/scene.toml")
        scene.save("out/scene.toml")
        self.assertEqual(sorted(os.listdir("out")), ["scene.toml"])
        self.assertEqual(beauty(orrery.load("out/scene.toml")), beauty(scene))

    def test_textures_and_data_files_move_with_the_scene(self):
        with open("points.csv", "w") as file:
            file.write("x,y,z\n0,0,-2\n")
        small_scene(positions()).render(8, 4, samples=1).write("map.png")
        with open("here.toml", "w") as file:
            file.write(SCENE + '[material.map]\ntype = "lambertian"\nalbedo = { texture = "image", file = "map.png" }\n'
                               '[[points]]\nfile = "points.csv"\nradius = 1\nmaterial = "map"\n')
        os.makedirs("there")
        scene = orrery.load("here.toml")  # a name without a folder
        scene.save("there/scene.toml")
        moved = orrery.load("there/scene.toml")
        self.assertTrue(np.array_equal(moved.render(*SIZE).beauty, scene.render(*SIZE).beauty))

    def test_no_input_is_replaced(self):
        scene = small_scene(positions())
        scene.save("scene.toml")
        loaded = orrery.load("scene.toml")
        with self.assertRaisesRegex(orrery.UsageError, "scene.toml"):
            loaded.save("scene.toml")
        with self.assertRaises(orrery.UsageError):
            loaded.save("scene.positions-1.ply")
        os.link("scene.positions-1.ply", "link.exr")
        with self.assertRaises(orrery.UsageError):
            loaded.render(4, 4).write("link.exr")
        scene.save("scene.toml")  # its own files

    def test_images_do_not_replace_their_scene(self):
        small_scene(positions()).save("scene.toml")
        with open("scene.toml", "rb") as file:
            text = file.read()
        os.symlink("scene.toml", "link.png")
        picture = orrery.load("scene.toml").render(16, 9, samples=1)
        with self.assertRaisesRegex(orrery.UsageError, r"scene.toml \(scene\)"):
            picture.write("link.png")
        with open("scene.toml", "rb") as file:
            self.assertEqual(file.read(), text)

    def test_other_files_are_not_replaced(self):
        write("scene.positions-1.ply", "not from orrery")
        with self.assertRaisesRegex(orrery.OutputError, r"was not written by save\(\)"):
            small_scene(positions()).save("scene.toml")
        write("scene.positions-1.ply", "ply\nformat binary_little_endian 1.0\ncomment made by orrery\n")
        with self.assertRaisesRegex(orrery.OutputError, r"was not written by save\(\)"):  # but by orrery convert
            small_scene(positions()).save("scene.toml")
        self.assertFalse(os.path.exists("scene.toml"))
        with self.assertRaises(OSError):
            small_scene(positions()).save("none/scene.toml")

    def test_an_invalid_scene_is_not_saved(self):
        scene = small_scene(positions(), material="gold")
        with self.assertRaises(orrery.SceneError):
            scene.save("scene.toml")
        self.assertEqual(os.listdir(), [])

    def test_frames(self):
        write("scene.toml", SCENE + '[[key]]\ntarget = "sphere[1].center"\nframes = [1, 3]\n'
                                    "values = [[1, 0, -2], [-1, 0, -2]]\n")
        scene = orrery.load("scene.toml")
        self.assertNotEqual(scene.render(frame=1).beauty.tobytes(), scene.render(frame=3).beauty.tobytes())

    def test_scenes_of_the_project(self):
        for name in ("book/final.toml", "trade/glass.toml"):
            path = os.path.join(ROOT, "scenes", name)
            orrery.load(path).save("scene.toml")
            self.assertEqual(
                orrery.load(path).render(32, 18, samples=1).beauty.tobytes(),
                orrery.load("scene.toml").render(32, 18, samples=1).beauty.tobytes(),
            )


class ReadPoints(FolderTest):
    def test_columns_are_arrays(self):
        write("a.csv", "x,y,z,diameter,vx,vy,vz,element\n1,2,3,1,3,4,0,H\n4,5,6,2,0,0,0,O\n")
        points = orrery.read_points("a.csv")
        np.testing.assert_array_equal(points.positions, [[1, 2, 3], [4, 5, 6]])
        np.testing.assert_array_equal(points.radius, [0.5, 1])
        np.testing.assert_array_equal(points["speed"], [5, 0])
        self.assertEqual(points["element"], ["H", "O"])
        self.assertEqual((points.frames, points.box), (1, None))
        self.assertEqual(list(orrery.read_points("a.csv", columns=["speed"])), ["speed"])
        points["x"][0] = 7  # the array is the caller's
        with self.assertRaises(KeyError):
            points["mass"]
        with self.assertRaisesRegex(ValueError, "has no column `mass`"):
            orrery.read_points("a.csv", columns=["mass"])
        with self.assertRaisesRegex(ValueError, "there is no frame 2"):
            orrery.read_points("a.csv", frame=2)
        with self.assertRaises(FileNotFoundError):
            orrery.read_points("b.csv")
        write("c.csv", "nothing")
        with self.assertRaises(orrery.SceneError):
            orrery.read_points("c.csv")

    def test_types_are_those_of_the_file(self):
        p = positions().astype(np.float32)
        table = np.zeros(60, dtype=[("x", "f4"), ("y", "f4"), ("z", "f4"), ("id", "i8"), ("n", "u2")])
        for axis, name in enumerate("xyz"):
            table[name] = p[:, axis]
        table["id"] = np.arange(60)
        np.save("a.npy", table)
        points = orrery.read_points("a.npy")
        self.assertEqual(points.positions.dtype, np.float32)
        np.testing.assert_array_equal(points.positions, p)
        self.assertEqual((points["id"].dtype, points["n"].dtype), (np.int64, np.uint16))

    def test_box(self):
        write("a.xyz", '1\nLattice="2 0 0 0 3 0 0 0 4" Properties=species:S:1:pos:R:3\nAr 1 2 3\n')
        origin, edges, periodic = orrery.read_points("a.xyz").box
        np.testing.assert_array_equal(np.diag(edges), [2, 3, 4])
        self.assertEqual((origin.shape, periodic.all()), ((3,), True))

    def test_the_same_image_as_the_file(self):
        p = np.random.default_rng(3).normal(size=(50, 3))
        np.save("a.npy", p)
        points = orrery.read_points("a.npy")
        from_file = orrery.Scene(camera=orrery.Camera.fit(p, 0.3))
        from_file.set("points", [{"file": "a.npy", "material": "matte", "radius": 0.3}])
        from_arrays = orrery.Scene(camera=orrery.Camera.fit(p, 0.3))
        from_arrays.add_points(points.positions, radius=0.3)
        self.assertEqual(beauty(from_file), beauty(from_arrays))


if __name__ == "__main__":
    unittest.main()
