# SPDX-License-Identifier: Apache-2.0
"""plot(): the same bits as the program, from files, arrays, ASE and MDAnalysis."""

import importlib.util
import types
import unittest
import warnings

import numpy as np
import orrery
from support import FolderTest, positions, run

SMALL = {"width": 48, "height": 27, "samples": 2, "threads": 2}
OPTIONS = ("--width", 48, "--height", 27, "--samples", 2)

XYZ = """5
Lattice="9 0 0 0 9 0 0 0 9" Properties=species:S:1:pos:R:3:vx:R:1:vy:R:1:vz:R:1
C 1 1 1 0 0 1
O 2.5 1 1 0 2 0
H 1 2 1 1 0 0
N 8.75 1 1 0 0 0
S 4 4 4 1 1 1
"""
SYMBOLS = ["C", "O", "H", "N", "S"]
PLACES = np.array([[1, 1, 1], [2.5, 1, 1], [1, 2, 1], [8.75, 1, 1], [4, 4, 4]])
VELOCITIES = np.array([[0, 0, 1], [0, 2, 0], [1, 0, 0], [0, 0, 0], [1, 1, 1.0]])
LOOK = {"representation": "ball-and-stick", "bonds": True, "box": True, "vectors": ("vx", "vy", "vz")}
WORDS = ("--representation", "ball-and-stick", "--bonds", "auto", "--box", "--vectors", "vx,vy,vz")


class Atoms:
    """What plot() uses of an ase.Atoms."""

    def __init__(self):
        self.arrays = {"positions": PLACES, "numbers": np.arange(5), "momenta": VELOCITIES * 2, "tag": np.arange(5)}
        self.cell, self.pbc = np.eye(3) * 9, [True] * 3

    def __len__(self):
        return len(SYMBOLS)

    def get_positions(self):
        return self.arrays["positions"]

    def get_chemical_symbols(self):
        return SYMBOLS

    def has(self, name):
        return name in self.arrays

    def get_velocities(self):
        return self.arrays["momenta"] / 2


class Group:
    """What plot() uses of an MDAnalysis.AtomGroup."""

    def __init__(self):
        self.positions, self.velocities = PLACES.astype(np.float32), VELOCITIES.astype(np.float32)
        self.elements, self.resnames = np.array(SYMBOLS, dtype=object), np.array(["A"] * 5, dtype=object)
        timestep = types.SimpleNamespace(dimensions=np.full(6, 9), triclinic_dimensions=np.eye(3) * 9, has_velocities=True)
        self.universe = types.SimpleNamespace(trajectory=types.SimpleNamespace(ts=timestep))
        self.atoms = self

    def __len__(self):
        return len(SYMBOLS)


def render(data, **options):
    return orrery.plot(data, **{**SMALL, **options})


class PlotTest(FolderTest):
    def setUp(self):
        super().setUp()
        with open("a.xyz", "w") as file:
            file.write(XYZ)

    def assert_as_program(self, picture, *arguments):
        """Asserts that the program makes the same image."""
        status, error = run("plot", "a.xyz", "-o", "a.exr", "-q", "--type", "float", *OPTIONS, *arguments)
        self.assertEqual(status, 0, error)
        picture.write("b.exr", type="float")
        status, error = run("compare", "a.exr", "b.exr", "--fail-above", "max=0")
        self.assertEqual(status, 0, error)


class Plot(PlotTest):
    def test_a_file_has_the_bits_of_the_program(self):
        picture = render("a.xyz", **LOOK)
        self.assert_as_program(picture, *WORDS)
        self.assertIn("1.2 times the sum of the covalent radii", " ".join(picture.notes))

    def test_the_default_quality_is_that_of_the_program(self):
        picture = orrery.plot("a.xyz", width=48, height=27)
        status, error = run("plot", "a.xyz", "-o", "a.exr", "-q", "--type", "float", "--width", 48, "--height", 27)
        self.assertEqual(status, 0, error)
        picture.write("b.exr", type="float")
        status, error = run("compare", "a.exr", "b.exr", "--fail-above", "max=0")
        self.assertEqual(status, 0, error)
        self.assertIn("quality good", " ".join(picture.notes))

    def test_annotations_are_in_the_files(self):
        words = ("--title", "frame {frame}", "--scale-bar", "2 nm", "--outline", "2", "--label", 'species == "S": sulphur', "--color-bar")
        status, error = run("plot", "a.xyz", "-o", "a.png", "-q", "--width", 160, "--height", 90, "--samples", 2, *words)
        self.assertEqual(status, 0, error)
        picture = orrery.plot(
            "a.xyz", width=160, height=90, samples=2, title="frame {frame}", scale_bar="2 nm", outline=2,
            label=['species == "S": sulphur'], color_bar=True,
        )  # fmt: skip
        picture.write("b.png")
        status, error = run("compare", "a.png", "b.png", "--fail-above", "max=0")
        self.assertEqual(status, 0, error)
        orrery.plot("a.xyz", width=160, height=90, samples=2).write("c.png")
        self.assertEqual(run("compare", "a.png", "c.png", "--fail-above", "max=0")[0], 1)

    def test_options_have_the_values_of_the_command_line(self):
        picture = render(
            "a.xyz", look_from=(10, -20), select=["z > 0", "x < 8"], color_by="vx", range=(-1, 2.5), bonds=1.5,
            replicate=(1, 2, 1), opacity=["0.5", 'species == "C": 1'], settings={"render.seed": 7}, ground=True,
            axes=False, slice=None, radius_scale=np.float32(0.5),
        )  # fmt: skip
        self.assert_as_program(
            picture, "--look-from=10,-20", "--select", "z > 0", "--select", "x < 8", "--color-by=vx", "--range=-1:2.5",
            "--bonds=1.5", "--replicate=1,2,1", "--opacity=0.5", '--opacity=species == "C": 1', "--set=render.seed=7",
            "--ground", "--radius-scale=0.5",
        )  # fmt: skip

    def test_atoms_have_the_bits_of_their_extended_xyz_file(self):
        self.assert_as_program(render(Atoms(), **LOOK), *WORDS)
        self.assert_as_program(render(Group(), **LOOK), *WORDS)
        self.assert_as_program(render(orrery.read_points("a.xyz"), **LOOK), *WORDS)
        columns = {"element": SYMBOLS, **dict(zip(("vx", "vy", "vz"), VELOCITIES.T))}
        self.assert_as_program(render(PLACES, columns=columns, cell=(9, 9, 9), **LOOK), *WORDS)
        self.assert_as_program(render(PLACES, columns=columns, cell=np.eye(3) * 9, **LOOK), *WORDS)

    def test_a_vector_has_one_name(self):
        words = ("--vectors", "vx,vy,vz")
        atoms = Atoms()
        atoms.arrays["forces"] = VELOCITIES
        self.assert_as_program(render(atoms, vectors="forces"), *words)
        columns = {"element": SYMBOLS, "f": VELOCITIES}
        self.assert_as_program(render(PLACES, columns=columns, cell=(9, 9, 9), vectors="f"), *words)
        self.assert_as_program(render({**dict(zip("xyz", PLACES.T)), **columns}, cell=(9, 9, 9), vectors="f"), *words)

    def test_the_arrays_of_atoms_are_columns(self):
        self.assertNotEqual(render(Atoms(), color_by="tag").beauty.tobytes(), render(Atoms()).beauty.tobytes())
        self.assertNotEqual(render(Group(), color_by="residue").beauty.tobytes(), render(Group()).beauty.tobytes())

    def test_atoms_without_a_cell_have_no_box(self):
        atoms = Atoms()
        atoms.cell = np.zeros((3, 3))
        render(atoms)
        with self.assertRaisesRegex(orrery.SceneError, "has no simulation box"):
            render(atoms, box=True)

    def test_arrays_replace_columns(self):
        points, values = positions(), np.arange(60.0)
        table = {**dict(zip("xyz", points.T)), "q": values, "r": 0.1 + values / 100, "a": values / 60}
        wanted = render(table, color_by="q", radius="r", opacity="a").beauty
        self.assertTrue((render(points, color_by=values, radius=table["r"], opacity=table["a"]).beauty == wanted).all())

    def test_opacities_may_be_conditions(self):
        rules = ["0.5", "x > 0: 0.1"]
        columns = dict(zip("xyz", positions().T))
        self.assertTrue((render(positions(), opacity=rules).beauty == render(columns, opacity=rules).beauty).all())
        self.assertFalse((render(positions(), opacity=rules).beauty == render(positions()).beauty).all())

    def test_errors_say_what_is_wrong(self):
        points = positions()
        for error, text, data, options in (
            (orrery.UsageError, "unknown option --colour-by; did you mean `--color-by`", points, {"colour_by": "x"}),
            (orrery.SceneError, "has no column `q`", points, {"color_by": "q"}),
            (orrery.MissingInputError, "nothing.xyz", "nothing.xyz", {}),
            (ValueError, "must have the shape", points[:, :2], {}),
            (ValueError, "cell must be finite numbers", points, {"cell": 3}),
            (ValueError, "cell must be finite numbers", points, {"cell": (1, 2, np.nan)}),
            (ValueError, "cell has no volume", points, {"cell": (1, 2, 0)}),
            (ValueError, "radius: must be above 0", points, {"radius": -1}),
            (ValueError, "radius has values below 0, e.g. -2", points, {"radius": np.linspace(-2, 1, 60)}),
            (ValueError, "already", points, {"columns": {"x": np.zeros(60)}}),
            (ValueError, "one value per position", points, {"color_by": np.zeros(3)}),
            (TypeError, "own columns and box", "a.xyz", {"cell": (9, 9, 9)}),
            (TypeError, "must be a number, a str", points, {"style": {}}),
            (TypeError, "on_progress", points, {"on_progress": 3}),
            (TypeError, "", 7, {}),
            (orrery.SceneError, "no columns|position|x, y", {"q": np.zeros(3)}, {}),
        ):
            with self.subTest(text=text, options=options), self.assertRaisesRegex(error, text):
                render(data, **options)

    def test_an_exception_in_on_progress_stops_the_render(self):
        def stop(progress):
            raise KeyError("enough")

        with self.assertRaisesRegex(KeyError, "enough"):
            render(positions(), samples=1 << 20, on_progress=stop)


@unittest.skipUnless(importlib.util.find_spec("ase"), "ASE is not installed")
class Ase(PlotTest):
    def test_a_trajectory(self):
        import ase
        import ase.io

        atoms = ase.Atoms(SYMBOLS, PLACES, cell=[9, 9, 9], pbc=True)
        ase.io.write("a.xyz", atoms, format="extxyz")
        self.assert_as_program(render(atoms, bonds=True, box=True), "--bonds", "auto", "--box")
        atoms.set_velocities(VELOCITIES)
        render(atoms, vectors=("vx", "vy", "vz"))


@unittest.skipUnless(importlib.util.find_spec("MDAnalysis"), "MDAnalysis is not installed")
class MdAnalysis(PlotTest):
    def test_a_universe_and_its_groups(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of MDAnalysis
            import MDAnalysis

            universe = MDAnalysis.Universe.empty(5, trajectory=True, velocities=True)
            universe.add_TopologyAttr("elements", SYMBOLS)
            universe.atoms.positions, universe.atoms.velocities = PLACES, VELOCITIES
            universe.dimensions = [9, 9, 9, 90, 90, 90]
        self.assert_as_program(render(universe, **LOOK), *WORDS)
        self.assert_as_program(render(universe.atoms[:3]), "--select", "x < 3")


if __name__ == "__main__":
    unittest.main()
