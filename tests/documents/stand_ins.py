#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes small files under the names of the data files that the documents mention.

    stand_ins.py FOLDER
"""

import math
import pathlib
import random
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
CORPUS = ROOT / "tests/fuzz/corpus/data"
random.seed(1)


def dump(frames, columns, rows_of):
    """A LAMMPS dump in a box of side 100."""
    out = []
    for step in range(frames):
        rows = rows_of(step)
        out.append(f"ITEM: TIMESTEP\n{100 * step}\nITEM: NUMBER OF ATOMS\n{len(rows)}\nITEM: BOX BOUNDS pp pp pp\n")
        out.append("0 100\n" * 3 + f"ITEM: ATOMS id type {columns}\n")
        out += [f"{i + 1} {1 + i % 2} " + " ".join(f"{x:.3f}" for x in row) + "\n" for i, row in enumerate(rows)]
    return "".join(out)


def uniform(low, high, count):
    return [random.uniform(low, high) for _ in range(count)]


def melt(step):
    return [uniform(0, 25, 2) + uniform(83, 99, 1) + uniform(-4, 4, 3) for _ in range(100)]


def pour(step):
    return [uniform(0.3, 0.8, 1) + uniform(0, 20, 2) + [20 - step % 20] + uniform(-3, 0, 3) for _ in range(30)]


def indent(step):
    return [uniform(0, 30, 3) + uniform(0, 4, 1) for _ in range(100)]


def polymer():
    """120 chains of four beads, as LAMMPS data with bonds."""
    out = ["chains\n\n480 atoms\n360 bonds\n1 atom types\n1 bond types\n\n0 30 xlo xhi\n0 30 ylo yhi\n0 30 zlo zhi\n"]
    out.append("\nMasses\n\n1 1\n\nAtoms # bond\n\n")
    for chain in range(120):
        x, y, z = uniform(0, 26, 3)
        out += [f"{chain * 4 + i + 1} {chain + 1} 1 {x + i:.3f} {y:.3f} {z:.3f} 0 0 0\n" for i in range(4)]
    out.append("\nBonds\n\n")
    for chain in range(120):
        out += [f"{chain * 3 + i + 1} 1 {chain * 4 + i + 1} {chain * 4 + i + 2}\n" for i in range(3)]
    return "".join(out)


def pdb():
    """Six chains of 80 residues, each a helix of backbones, an atom of haem, and an assembly of two copies."""
    out = ["REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A, B, C, D, E, F\n"]
    for copy, sign in ((1, 1), (2, -1)):
        for axis in range(3):
            row = [sign if column == axis and axis < 2 else 1.0 if column == axis else 0.0 for column in range(3)]
            out.append(f"REMARK 350   BIOMT{axis + 1}{copy:4d}" + "".join(f"{x:10.6f}" for x in row) + "        0.00000\n")
    serial = 0
    for number, chain in enumerate("ABCDEF"):
        for residue in range(1, 81):
            for atom, element, turn in (("N", "N", 0.0), ("CA", "C", 0.3), ("C", "C", 0.6)):
                serial += 1
                angle = math.radians(100) * (residue + turn)
                x, y = 15 * number + 5 + 2.3 * math.cos(angle), 10 + 2.3 * math.sin(angle)
                z = 1.5 * (residue + turn - 40)
                out.append(f"ATOM  {serial:5d}  {atom:<3} GLY {chain}{residue:4d}    {x:8.3f}{y:8.3f}{z:8.3f}  1.00  0.00          {element:>2}\n")
    haem = "HETATM 1441 FE   HEM A 201       9.000  10.000   0.000  1.00  0.00          FE\n"
    return "".join(out) + haem + "END\n"


def scene():
    """A scene with two spheres, a light group and an animation."""
    return """[image]
width = 96
height = 54
[camera]
look_from = [0, 1, 6]
look_at = [0, 0.5, 0]
vfov = 40
[render]
samples = 16
[material]
grey = { type = "lambertian", albedo = [0.5, 0.5, 0.5] }
gold = { type = "metal", albedo = [0.8, 0.6, 0.2], fuzz = 0.1 }
"dark gold" = { type = "metal", albedo = [0.4, 0.3, 0.1], fuzz = 0.1 }
lamp = { type = "emitter", radiance = [9, 9, 9], light_group = "key" }
[[sphere]]
center = [0, 0.5, 0]
radius = 0.5
material = "gold"
[[sphere]]
center = [1.2, 0.5, 0]
radius = 0.5
material = "dark gold"
[[sphere]]
center = [0, -1000, 0]
radius = 1000
material = "grey"
[[sphere]]
center = [2, 4, 2]
radius = 0.5
material = "lamp"
"""


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    velocity = " vx vy vz"
    texts = {
        "melt.dump": dump(3, "x y z" + velocity, melt),
        "pour.dump": dump(101, "radius x y z" + velocity, pour),
        "indent.dump": dump(2, "x y z c_symmetry", indent),
        "polymer.data": polymer(),
        "chains.data": polymer(),
        "1M4X.pdb": pdb(),
        "3J6R.pdb": pdb(),
        "4HHB.pdb": pdb(),
        "caffeine.xyz": "3\nwater\nO 0 0 0\nH 0.96 0 0\nH -0.24 0.93 0\n",
        "scene.toml": scene(),
        "shot.toml": scene(),
        "first.toml": scene(),
    }
    for name, text in texts.items():
        (folder / name).write_text(text)
    scan = (CORPUS / "las/format3.las").read_bytes()
    snapshot = (CORPUS / "hdf5/plain.hdf5").read_bytes().replace(b"PartType1", b"PartType4")
    for name, data in {"scan.las": scan, "autzen_trim.las": scan, "snapshot.hdf5": snapshot}.items():
        (folder / name).write_bytes(data)
    for name, seed in {"quartz.cif": "cif/quartz.cif", "md.xtc": "xtc/water.xtc", "conf.gro": "gro/water.gro"}.items():
        (folder / name).write_bytes((CORPUS / seed).read_bytes())


main()
