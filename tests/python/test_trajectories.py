#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Crystals and trajectories, as ASE and MDAnalysis read them."""

import importlib.util
import itertools
import os
import shutil
import unittest
import warnings
from fractions import Fraction

import numpy as np
import orrery
from support import ROOT, FolderTest

SEEDS = os.path.join(ROOT, "tests", "fuzz", "corpus", "data")
POSITION = ("x", "y", "z")


def quietly(function):
    """Runs a test without the warnings of other packages."""

    def run(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            function(self)

    return run


def array(points, columns=POSITION):
    return np.stack([points[name] for name in columns], axis=1)


@unittest.skipUnless(importlib.util.find_spec("MDAnalysis"), "MDAnalysis is not installed")
class Trajectories(FolderTest):
    def assert_same(self, file, universe):
        """Compares all frames of a file, to the last bit of the positions."""
        from MDAnalysis.lib.mdamath import triclinic_vectors

        for number, step in enumerate(universe.trajectory, 1):
            points = orrery.read_points(file, frame=number)
            self.assertEqual(points.frames, len(universe.trajectory))
            self.assertEqual(array(points).tobytes(), step.positions.tobytes(), (file, number))
            if step.has_velocities:
                velocity = array(points, [f"velocity[{i}]" for i in (1, 2, 3)])
                self.assertEqual(velocity.tobytes(), step.velocities.tobytes(), (file, number))
            if step.dimensions is not None:
                edges = triclinic_vectors(step.dimensions)
                np.testing.assert_allclose(points.box[1], edges, atol=2e-4, err_msg=f"{file} {number}")

    @quietly
    def test_files_of_gromacs(self):
        import MDAnalysis

        for name in ("gro/water.gro", "gro/dodecahedron.gro", "xtc/water.xtc", "trr/water.trr"):
            file = shutil.copy(os.path.join(SEEDS, name), ".")  # MDAnalysis writes a file beside it
            is_text = name.endswith(".gro")
            universe = MDAnalysis.Universe(file) if is_text else MDAnalysis.Universe.empty(30).load_new(file)
            self.assert_same(file, universe)

    @quietly
    def test_files_of_mdanalysis(self):
        """Few atoms, coordinates of more than 24 bits, runs of equal positions, and boxes of all kinds."""
        import MDAnalysis

        random = np.random.default_rng(7)
        cases = [(9, 5, [30, 31, 32, 80, 70, 60]), (10, 5, None), (1000, 20, [30, 31, 32, 90, 90, 90])]
        cases += [(2000, 2e5, [30, 31, 32, 90, 90, 120]), (500, 1e-3, [5, 5, 9, 60, 60, 90]), (300, 0, None)]
        for (count, size, box), ending in itertools.product(cases, ("xtc", "trr", "dcd")):
            universe = MDAnalysis.Universe.empty(count, trajectory=True)
            file = f"{count}.{ending}"
            with MDAnalysis.Writer(file, count) as writer:
                for _ in range(3):
                    universe.atoms.positions = random.standard_normal((count, 3)) * size
                    universe.dimensions = box
                    writer.write(universe.atoms)
            self.assert_same(file, MDAnalysis.Universe.empty(count).load_new(file))


def cell_of(number):
    """Edges and angles that a space group may have, on hexagonal axes where there is a choice."""
    a, b, c = 10.7, 12.5, 13.8
    for last, cell in (
        (2, [a, b, c, 83, 97, 105]),
        (15, [a, b, c, 90, 97, 90]),
        (74, [a, b, c, 90, 90, 90]),
        (142, [a, a, c, 90, 90, 90]),
        (194, [a, a, c, 90, 90, 120]),
        (230, [c, c, c, 90, 90, 90]),
    ):
        if number <= last:
            return cell


def triplet(rotation, translation):
    """An operator as CIF writes it: "x,-y,z+1/2"."""

    def coordinate(row, shift):
        shift = Fraction(float(shift)).limit_denominator(24)
        axes = "".join(("", "+", "-")[int(row[k])] + "xyz"[k] for k in range(3) if row[k])
        return f"{axes}+{shift}" if shift else axes

    return ",".join(map(coordinate, rotation, translation))


@unittest.skipUnless(importlib.util.find_spec("ase"), "ASE is not installed")
class Crystals(FolderTest):
    """A general position and special ones in all space groups, by operators, by symbols and by numbers."""

    SITES = {"Si": (0.44, 0.16, 0.22), "O": (0, 0, 0), "C": (0.5, 0.5, 0.5), "N": (0.3, 0.3, 0.3), "F": (0.17, 0, 0)}

    @quietly
    def test_all_space_groups(self):
        from ase.spacegroup import Spacegroup

        for number, setting in itertools.product(range(1, 231), (1, 2)):
            try:
                group = Spacegroup(number, setting)
            except Exception:  # ASE's own; the group has one setting
                continue
            cell = cell_of(number) if group.lattice != "R" or setting == 1 else [12.5] * 3 + [70] * 3
            with self.subTest(number=number, setting=setting):
                for symmetry in self.symmetries(group):
                    self.assert_same(group, cell, symmetry)

    @staticmethod
    def symmetries(group):
        operators = "\n".join(f"'{triplet(r, t)}'" for r, t in zip(*map(list, zip(*group.get_symop()))))
        out = ["loop_\n_space_group_symop_operation_xyz\n" + operators]
        if group.setting == 1:  # the others have symbols of their own
            out += [f"_symmetry_space_group_name_H-M '{group.symbol}'", f"_space_group_IT_number {group.no}"]
        return out

    def assert_same(self, group, cell, symmetry):
        names = "length_a length_b length_c angle_alpha angle_beta angle_gamma".split()
        rows = [f"{element} {x} {y} {z}" for element, (x, y, z) in self.SITES.items()]
        fractions = [f"_atom_site_fract_{axis}" for axis in POSITION]
        text = ["data_a", *(f"_cell_{name} {value}" for name, value in zip(names, cell)), symmetry]
        with open("a.cif", "w") as file:
            file.write("\n".join([*text, "loop_", "_atom_site_label", *fractions, *rows, ""]))
        points = orrery.read_points("a.cif")
        ours = array(points, [f"fract_{axis}" for axis in POSITION])
        for element, site in self.SITES.items():
            theirs, _ = group.equivalent_sites([site])
            found = ours[np.array(list(points["element"])) == element]
            self.assertEqual(len(found), len(theirs), (element, symmetry))
            distance = found[:, None] - theirs[None]
            distance = np.abs(distance - np.round(distance)).max(axis=2)
            self.assertLess(distance.min(axis=1).max(), 1e-6, (element, symmetry))
            self.assertEqual(len(set(distance.argmin(axis=1))), len(theirs), (element, symmetry))

    @quietly
    def test_files_of_ase(self):
        import ase.io
        from ase.spacegroup import crystal

        rutile = crystal(["Ti", "O"], [(0, 0, 0), (0.305, 0.305, 0)], spacegroup=136, cellpar=[4.6, 4.6, 2.95, 90, 90, 90])
        moved = rutile.copy()
        moved.rattle(0.1, seed=1)
        ase.io.write("a.cif", [rutile, moved])
        ase.io.write("POSCAR", moved, format="vasp", direct=True)
        ase.io.write("CONTCAR", moved, format="vasp")
        ase.io.write("XDATCAR", [rutile, moved], format="vasp-xdatcar")
        for file, frame, expected in [
            ("a.cif", 1, rutile),
            ("a.cif", 2, moved),
            ("POSCAR", 1, moved),
            ("CONTCAR", 1, moved),
            ("XDATCAR", 1, rutile),
            ("XDATCAR", 2, moved),
        ]:
            points = orrery.read_points(file, frame=frame)
            self.assertEqual(list(points["element"]), expected.get_chemical_symbols(), file)
            np.testing.assert_allclose(points.box[1], expected.cell, atol=1e-6, err_msg=file)
            ours, theirs = (np.linalg.solve(expected.cell.T, p.T).T for p in (array(points), expected.positions))
            np.testing.assert_allclose(ours - np.round(ours - theirs), theirs, atol=2e-5, err_msg=file)


if __name__ == "__main__":
    unittest.main()
