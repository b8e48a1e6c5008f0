# SPDX-License-Identifier: Apache-2.0
"""plot(): particles from files, arrays, ASE and MDAnalysis, by the options of `orrery plot`."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from orrery import _arguments, _arrays, _keys, _orrery
from orrery._errors import SceneWarning
from orrery._picture import Picture
from orrery._scene import Progress, _limits

_REPEATED = ("select", "slice", "opacity", "label")  # options that can be given several times
_PER_PARTICLE = ("radius", "color_by", "opacity")  # options that arrays may replace


def plot(
    data: Any,
    *,
    columns: Mapping[str, Any] | None = None,
    cell: Any = None,
    threads: int | None = None,
    memory_limit: int | None = None,
    on_progress: Callable[[Progress], object] | None = None,
    **options: Any,
) -> Picture:
    """Renders particles and returns a Picture, with the same bits as `orrery plot`.

    data           a data file (docs/data.md); positions of shape (n, 3); a mapping of columns with x, y and z, such as
                   Points; an ASE Atoms; or an MDAnalysis AtomGroup or Universe, in its current frame
    columns        further columns by name, shape (n,): numbers or strings
    cell           edges of the periodic simulation box by rows, shape (3, 3), or (3,) for a rectangular one; by default
                   the box of the atoms or Points. box=True draws it
    threads, memory_limit, on_progress   as for Scene.render()
    options        of `orrery plot --help`, with underscores: color_by="type", style="night", width=960, noise=0.05,
                   bonds=True, outline=2, scale_bar="2 nm", vectors=("vx", "vy", "vz"), range=(0, 5), select=["z > 0", "type == 1"],
                   settings={"render.seed": 7}. radius, color_by and opacity may be arrays of shape (n,)

    What was chosen from the data is in the picture's `notes`. Title, scale bar, color bar, labels and outlines are in the
    files that write() makes; `beauty` and to_srgb8() are without them.
    """
    if "frames" in options:
        raise TypeError("plot() renders one frame, frame=N; movie() renders several")
    columns, options = _named(data, columns, options)
    source = _source(data, columns, cell)
    limits, report = _limits(threads, memory_limit, on_progress)
    native, notes = _orrery.plot(source, _words(options), *limits, report, _warn)
    return Picture(native, notes)


def _warn(text):
    warnings.warn(text.rstrip("\n"), SceneWarning, stacklevel=4)


def _named(data, columns, options):
    """Returns the columns with the arrays among the options, and the options with the names of these columns."""
    columns = dict(columns or {})
    if not isinstance(data, (str, bytes, os.PathLike)):
        arrays = {name: values for name, values in options.items() if name in _PER_PARTICLE and _is_array(name, values)}
        radii = np.asarray(arrays.get("radius", []))
        if radii.dtype.kind in "fi" and (radii < 0).any():
            raise ValueError(f"radius has values below 0, e.g. {np.nanmin(radii)}; radii must be above 0")
        columns.update(arrays)
        options = {**options, **{name: name for name in arrays}}
    return columns, options


def _is_array(name, values):
    """Whether an option has a value for each particle; texts are categories, but those of opacities are conditions."""
    return np.ndim(values) == 1 and not (name in _REPEATED and np.asarray(values).dtype.kind == "U")


def _source(data, columns, cell):
    """Returns the name of a file, or columns and box."""
    table, own_box = _table(data)
    if table is None:
        if columns or cell is not None:
            raise TypeError("a file has its own columns and box; to change them, pass read_points(file)")
        return _arguments.path("data", data)
    rows = len(next(iter(table.values())))
    for name, values in columns.items():
        _add(table, _arguments.text("a name in columns", name), values, rows)
    return _arrays.native(table), own_box if cell is None else _cell(cell)


def _words(options):
    """Returns the words of the command line."""
    out = []
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        if name == "settings":
            out += [f"--set={_arguments.text('a key', key)}={_keys.toml_text(v)}" for key, v in value.items()]
        elif value is True:
            out.append(option + "=auto" if name == "bonds" else option)
        elif name in _REPEATED and isinstance(value, (list, tuple)):
            out += [f"{option}={_word(name, v)}" for v in value]
        elif isinstance(value, (list, tuple, np.ndarray)):
            out.append(f"{option}={(':' if name == 'range' else ',').join(_word(name, v) for v in value)}")
        else:
            out.append(f"{option}={_word(name, value)}")
    return out


def _word(name, value):
    if isinstance(value, str):
        return _arguments.text(name, value)
    if not _keys.is_number(value):
        raise TypeError(f"{name} is {value!r}; must be a number, a str, or a sequence of them")
    return repr(value.item() if isinstance(value, np.number) else value)


def _table(data):
    """Returns the columns of some particles and their box; None and None for the name of a file."""
    if hasattr(data, "get_chemical_symbols"):
        return _ase(data)
    if hasattr(data, "atoms") and hasattr(data, "universe"):
        return _mdanalysis(data.atoms)
    if isinstance(data, Mapping):
        lengths = {name: len(values) for name, values in data.items()}
        rows = next(iter(lengths.values()), 0)
        table = {}
        for name, values in data.items():
            _add(table, name, values, rows)
        return table, getattr(data, "box", None) and _periodic_box(*data.box)
    if isinstance(data, (np.ndarray, list, tuple)):
        return dict(zip("xyz", _arrays.positions(data).T)), None
    return None, None


def _add(table, name, values, rows):
    """Adds a column, or the components of vectors under the names that they have in files: forces[1] to forces[3]."""
    if np.ndim(values) == 2 and np.shape(values)[0] == rows:
        for i, component in enumerate(_arrays.numbers(values, name).T):
            _arrays.add_column(table, f"{name}[{i + 1}]", component)
    else:
        _arrays.add_column(table, name, _arrays.column(values, name, rows))


def _ase(atoms):
    """The columns of an ASE Atoms: element, and its arrays of numbers and vectors, as the extended XYZ file has them."""
    table = dict(zip("xyz", _arrays.positions(atoms.get_positions()).T))
    rows = len(atoms)
    table["element"] = _arrays.column(atoms.get_chemical_symbols(), "element", rows)
    for name, values in atoms.arrays.items():
        if name in ("positions", "numbers"):
            continue
        is_vector = np.ndim(values) == 2 and np.asarray(values).dtype.kind in "fiu"
        if name not in table and (np.ndim(values) == 1 or is_vector):
            _add(table, name, values, rows)
    if atoms.has("momenta"):
        table.update(zip(("vx", "vy", "vz"), _arrays.positions(atoms.get_velocities()).T))
    cell = np.array(atoms.cell, dtype=float)
    box = _periodic_box(np.zeros(3), cell, atoms.pbc) if abs(np.linalg.det(cell)) > 0 else None
    return table, box


def _mdanalysis(group):
    """The columns of an MDAnalysis AtomGroup, in its current frame."""
    table = dict(zip("xyz", _arrays.positions(group.positions).T))
    attributes = {
        "element": "elements", "name": "names", "type": "types", "residue": "resnames", "residue_number": "resids",
        "chain": "segids", "charge": "charges", "mass": "masses", "id": "ids",
    }  # fmt: skip
    for name, attribute in attributes.items():
        values = getattr(group, attribute, None)  # a topology has some of them
        if values is not None and np.shape(values) == (len(group),):
            table[name] = _arrays.column(values, name, len(group))
    timestep = group.universe.trajectory.ts
    if getattr(timestep, "has_velocities", False):
        table.update(zip(("vx", "vy", "vz"), _arrays.positions(group.velocities).T))
    edges = timestep.triclinic_dimensions if timestep.dimensions is not None else None
    return table, None if edges is None or not np.linalg.det(edges) > 0 else _periodic_box(np.zeros(3), edges)


def _cell(edges):
    array = np.asarray(edges, dtype=float)
    if array.shape == (3,):
        array = np.diag(array)
    if array.shape != (3, 3) or not np.isfinite(array).all():
        raise ValueError(f"cell must be finite numbers of shape (3, 3) or (3,), not {edges!r}")
    if np.linalg.det(array) == 0:
        raise ValueError(f"cell has no volume: its edges are {edges!r}")
    return _periodic_box(np.zeros(3), array)


def _periodic_box(origin, edges, periodic=(True, True, True)):
    return [float(x) for x in origin], [[float(x) for x in edge] for edge in edges], [bool(p) for p in periodic]
