# SPDX-License-Identifier: Apache-2.0
"""Arrays of all layouts and types give the same image; others are refused."""

import unittest

import numpy as np
import orrery
from support import FolderTest, beauty, positions, small_scene


class Layouts(unittest.TestCase):
    def setUp(self):
        self.positions = positions()
        self.wanted = beauty(small_scene(self.positions))

    def expect_same(self, array):
        np.testing.assert_array_equal(np.asarray(array, dtype=float), self.positions)
        self.assertEqual(beauty(small_scene(array)), self.wanted)

    def test_the_positions_matter(self):
        self.assertNotEqual(beauty(small_scene(self.positions + 0.5)), self.wanted)

    def test_types(self):
        for dtype in (np.float64, np.float32, np.float16, np.longdouble, ">f8", ">f4"):
            with self.subTest(dtype=dtype):
                self.expect_same(self.positions.astype(dtype))

    def test_integers(self):
        whole = np.unique(positions() // 1, axis=0)
        wanted = beauty(small_scene(whole))
        for dtype in (np.int64, np.int32, np.int16, np.int8):
            with self.subTest(dtype=dtype):
                self.assertEqual(beauty(small_scene(whole.astype(dtype))), wanted)

    def test_orders_and_strides(self):
        for dtype in (np.float64, np.float32):
            p = self.positions.astype(dtype)
            wide = np.full((2 * len(p), 7), np.nan, dtype)
            wide[::2, 1:6:2] = p
            packed = np.zeros(len(p), dtype=[("flag", "u1"), ("p", dtype, 3)])
            packed["p"] = p
            backwards = np.ascontiguousarray(p[::-1, ::-1])
            layouts = {
                "Fortran": np.asfortranarray(p),
                "strided": wide[::2, 1:6:2],
                "negative strides": backwards[::-1, ::-1],
                "not aligned": packed["p"],
                "transposed": np.ascontiguousarray(p.T).T,
                "list": p.tolist(),
            }
            for name, array in layouts.items():
                with self.subTest(dtype=dtype, layout=name):
                    self.expect_same(array)

    def test_masked_elements_are_refused(self):
        masked = np.ma.masked_array(self.positions, mask=self.positions > 0.5)
        with self.assertRaisesRegex(ValueError, "masked"):
            small_scene(masked)
        with self.assertRaisesRegex(ValueError, "masked"):
            small_scene(self.positions, radius=np.ma.masked_array(np.ones(len(self.positions)), mask=[True] + [False] * (len(self.positions) - 1)))
        self.expect_same(np.ma.masked_array(self.positions, mask=False))

    def test_read_only(self):
        p = self.positions.copy()
        p.flags.writeable = False
        self.expect_same(p)

    def test_arrays_are_read_without_a_copy(self):
        for order in "CF":
            p = np.array(self.positions - 0.5, order=order)
            scene = small_scene(p)
            p += 0.5
            self.assertEqual(beauty(scene), self.wanted)

    def test_the_scene_keeps_its_arrays(self):
        scene = small_scene(self.positions + 0)
        np.zeros((1000, 3))  # would take the memory
        self.assertEqual(beauty(scene), self.wanted)

    def test_empty(self):
        with self.assertWarnsRegex(orrery.SceneWarning, "no particles"):
            small_scene(np.empty((0, 3))).render(8, 8)

    def test_radii(self):
        radii = np.full(len(self.positions), 0.3)
        self.assertEqual(beauty(small_scene(self.positions, radius=radii)), self.wanted)
        self.assertEqual(beauty(small_scene(self.positions, radius=np.float64(0.3))), self.wanted)
        radii[::2] = 0.2
        self.assertNotEqual(beauty(small_scene(self.positions, radius=radii)), self.wanted)

    def test_colors_of_bytes_and_of_floats_agree(self):
        rgb = np.arange(3 * len(self.positions), dtype=np.uint8).reshape(-1, 3)
        wanted = beauty(small_scene(self.positions, color=rgb))
        self.assertNotEqual(wanted, self.wanted)
        self.assertEqual(beauty(small_scene(self.positions, color=rgb / 255.0)), wanted)
        self.assertEqual(beauty(small_scene(self.positions, color=rgb.astype(int))), wanted)

    def test_one_color_for_all(self):
        one = beauty(small_scene(self.positions, color=(1, 0.5, 0.25)))
        self.assertEqual(beauty(small_scene(self.positions, color=[[1, 0.5, 0.25]] * len(self.positions))), one)
        self.assertNotEqual(one, self.wanted)

    def test_colormap(self):
        x = self.positions[:, 0]
        viridis = beauty(small_scene(self.positions, color=orrery.colormap(x)))
        for color in (orrery.colormap(x, "magma"), orrery.colormap(x, range=(0, 1))):
            self.assertNotEqual(beauty(small_scene(self.positions, color=color)), viridis)
        keys = {"column": "x", "map": "viridis"}
        self.assertEqual(beauty(small_scene(self.positions, color=keys)), viridis)
        self.assertIn("viridis", orrery.color_maps)

    def test_nan_color(self):
        x = np.full(len(self.positions), np.nan)
        red, grey = orrery.colormap(x, nan_color=(1, 0, 0)), orrery.colormap(x)
        self.assertNotEqual(
            beauty(small_scene(self.positions, color=red)), beauty(small_scene(self.positions, color=grey))
        )

    def test_selection_by_a_column(self):
        keep = self.positions[:, 2] > 0
        picked = small_scene(self.positions, columns={"height": self.positions[:, 2]}, select="height > 0")
        self.assertEqual(beauty(picked), beauty(small_scene(self.positions[keep])))


class Strings(FolderTest):
    """Columns of strings, as read_points() returns them."""

    ELEMENTS = ["C", "H", "Na", "O"] * 15

    def test_all_kinds_of_arrays(self):
        keys = {"radius": {"element": "vdw"}, "color": {"element": "jmol"}, "select": "element in {C, O}"}
        wanted = None
        for elements in (self.ELEMENTS, np.array(self.ELEMENTS), np.array(self.ELEMENTS, object), np.array(self.ELEMENTS, "S")):
            image = beauty(small_scene(positions(), columns={"element": elements}, **keys))
            self.assertEqual(image, wanted or image)
            wanted = image
        others = ["C", "H", "Na", "N"] * 15
        self.assertNotEqual(beauty(small_scene(positions(), columns={"element": others}, **keys)), wanted)

    def test_each_string_has_a_color(self):
        numbers = np.array([self.ELEMENTS.index(e) for e in self.ELEMENTS])
        by_name = beauty(small_scene(positions(), color=orrery.colormap(self.ELEMENTS, "tab10")))
        self.assertEqual(by_name, beauty(small_scene(positions(), color=orrery.colormap(numbers + 1, "tab10"))))

    def test_columns_of_a_file_are_given_back(self):
        p = positions()
        with open("a.pdb", "w", encoding="ascii") as file:
            for n, (x, y, z) in enumerate(p):
                element, chain = self.ELEMENTS[n], "AB1"[n % 3]
                file.write(f"HETATM{n:5d} {element:<4} MOL {chain}{n:4d}    {x:8.3f}{y:8.3f}{z:8.3f}  1.00  0.00          {element:>2}\n")
            file.write("END\n")
        points = orrery.read_points("a.pdb")
        keys = {"material": "matte", "radius": {"element": "covalent"}, "select": "chain in {A, 1}", "color": {"column": "chain"}}
        columns = {name: points[name] for name in points if name not in ("x", "y", "z")}
        scene = small_scene(points.positions, columns=columns, **keys)
        from_file = orrery.Scene(camera=orrery.Camera.fit(positions(), 0.3), background=orrery.Gradient())
        from_file.set("points", [{"file": "a.pdb", **keys}])
        from_file.set("render.samples", 4)
        self.assertEqual(beauty(scene), beauty(from_file))

    def test_saved_as_npy(self):
        keys = {"radius": {"element": "vdw", "scale": 0.2}, "color": {"column": "name"}}
        names = [f"caf\u00e9 {n % 7}" for n in range(60)]
        scene = small_scene(positions(), columns={"element": self.ELEMENTS, "name": names}, **keys)
        for _ in range(2):  # the second time, it replaces its own files
            scene.save("saved.toml")
            self.assertEqual(beauty(orrery.load("saved.toml")), beauty(scene))
        large = small_scene(positions(), columns={"id": 1024 * np.arange(60) + 2**60},
                            select=f"id > {2**60 + 29 * 1024}")
        large.save("large.toml")
        self.assertEqual(beauty(orrery.load("large.toml")), beauty(large))
        with self.assertRaisesRegex(OSError, r"was not written by save\(\)"):
            np.save("other.positions-1.npy", np.zeros(3))
            scene.save("other.toml")


    def test_names_may_have_spaces(self):
        p = positions()
        with open("a.csv", "w", encoding="ascii") as file:
            file.write('x,y,z,"v (km/s)"\n')
            file.writelines(f"{x!r},{y!r},{z!r},{n}\n" for n, (x, y, z) in enumerate(p.tolist()))
        points = orrery.read_points("a.csv")
        keys = {"select": "`v (km/s)` > 29", "color": {"column": "v (km/s)"}}
        scene = small_scene(points.positions, columns={"v (km/s)": points["v (km/s)"]}, **keys)
        self.assertEqual(beauty(scene), beauty(small_scene(p[30:], color=orrery.colormap(np.arange(30)))))
        scene.save("saved.toml")
        self.assertEqual(beauty(orrery.load("saved.toml")), beauty(scene))


class BadInput(FolderTest):
    def refused(self, kind, text, array, **keys):
        with self.assertRaisesRegex(kind, text):
            small_scene(array, **keys)

    def test_shapes(self):
        for array in (np.zeros(3), np.zeros((3, 2)), np.zeros((3, 4)), np.zeros((2, 3, 3)), 5.0, []):
            self.refused(ValueError, r"positions must have the shape \(n, 3\)", array)
        p = positions()
        self.refused(ValueError, r"radius must have the shape \(60,\)", p, radius=np.ones(59))
        self.refused(ValueError, r"radius must have the shape \(60,\)", p, radius=np.ones((60, 1)))
        self.refused(ValueError, r"color must have the shape \(3,\) or \(60, 3\)", p, color=np.ones((60, 4)))
        self.refused(ValueError, r"colour map must have the shape \(60,\)", p, color=orrery.colormap(np.ones(3)))
        self.refused(ValueError, r"height must have the shape", p, columns={"height": np.ones(3)})
        self.refused(ValueError, "not a name for a column", p, columns={"a\nb": np.ones(60)})
        self.refused(ValueError, "there is a column 'x' already", p, columns={"x": np.ones(60)})
        with self.assertRaisesRegex(ValueError, r"values must have the shape"):
            orrery.colormap(p)

    def test_types(self):
        for values in ([None] * 60, [["a"]] * 60, ["a", 1] * 30, np.zeros(60, complex)):
            self.refused((TypeError, ValueError), "name must", positions(), columns={"name": values})
        for array in (np.zeros((3, 3), complex), np.full((3, 3), "a"), np.full((3, 3), None), [["a", "b", "c"]]):
            self.refused(TypeError, "positions must be an array of numbers", array)

    def test_ragged_lists(self):
        with self.assertRaises((ValueError, TypeError)):
            small_scene([[1, 2, 3], [4, 5]])

    def test_nan_and_infinite_positions(self):
        for value in (np.nan, np.inf, -np.inf):
            p = positions()
            p[3, 1] = value
            with self.assertRaisesRegex(orrery.SceneError, "(?s)row 4 of positions-1 has center .*skip_bad = true"):
                small_scene(p).render(8, 8)
            with self.assertWarnsRegex(orrery.SceneWarning, "1 of 60 rows were left out"):
                picture = small_scene(p, skip_bad=True).render(8, 8)
            self.assertEqual(picture.statistics["spheres"], 59)

    def test_huge_positions(self):
        p = positions()
        p[0, 0] = 1e300
        with self.assertRaisesRegex(orrery.SceneError, "row 1 of positions-1: center .*1e\\+300"):
            small_scene(p).check()

    def test_bad_radii(self):
        p = positions()
        for radii in (np.zeros(60), np.full(60, np.nan)):
            with self.assertRaisesRegex(orrery.SceneError, "row 1 of positions-1"):
                small_scene(p, radius=radii).check()
        radii = np.full(60, 0.3)
        radii[3] = -0.2
        for columns in ({}, {"name": ["a"] * 60}):
            for keys in ({"radius": radii}, {"radius": {"column": "size"}, "columns": {"size": radii}}):
                keys["columns"] = {**keys.get("columns", {}), **columns}
                with self.assertRaisesRegex(orrery.SceneError, "row 4 of positions-1 has center .* and radius -0.2"):
                    small_scene(p, **keys).check()
        with self.assertRaisesRegex(orrery.SceneError, "radius"):
            small_scene(p, radius=0).check()
        with self.assertRaisesRegex(orrery.SceneError, "the file has no radius"):
            orrery.Scene().add_points(p)

    def test_opacities(self):
        p = positions()
        plain = beauty(small_scene(p))
        for opacity in (0.3, np.linspace(0, 1, 60), {"where": ["x > 0: 0.2"]}):
            self.assertNotEqual(beauty(small_scene(p, opacity=opacity)), plain)
        self.assertEqual(beauty(small_scene(p, opacity=np.ones(60))), plain)
        with self.assertRaisesRegex(orrery.SceneError, "row 1 of positions-1 has opacity 2"):
            small_scene(p, opacity=np.full(60, 2)).check()

    def test_materials_by_condition(self):
        p = positions()
        scene = small_scene(p, material_where=["x > 0: gold"])
        scene.add_material("gold", orrery.Metal((0.8, 0.6, 0.2)))
        self.assertNotEqual(beauty(scene), beauty(small_scene(p)))

    def test_unknown_names(self):
        p = positions()
        with self.assertRaisesRegex(orrery.SceneError, 'there is no colour map "viridi".*did you mean `viridis`'):
            orrery.colormap(p[:, 0], "viridi")
        with self.assertRaisesRegex(orrery.SceneError, 'material is "gold", which is not defined'):
            small_scene(p, material="gold").check()
        with self.assertRaisesRegex(orrery.SceneError, "`gold` is not a material"):
            small_scene(p, material_where=["x > 0: gold"]).check()
        with self.assertRaisesRegex(orrery.SceneError, "has no column `speed`"):
            small_scene(p, color={"column": "speed"})
        with self.assertRaisesRegex(orrery.SceneError, "unknown key.*`selct`"):
            small_scene(p, selct="x > 0")


if __name__ == "__main__":
    unittest.main()
