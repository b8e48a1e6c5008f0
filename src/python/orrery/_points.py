# SPDX-License-Identifier: Apache-2.0
"""Data files as arrays, and colours of points."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from orrery import _arguments, _arrays, _keys, _orrery
from orrery._arguments import Path, Vector


@dataclasses.dataclass(repr=False, eq=False)
class ColorMap:
    """Values and the colour map that shows them; see colormap()."""

    values: NDArray[Any]
    name: str
    range: Sequence[float] | None
    nan_color: Vector | None

    def __repr__(self):
        return f"ColorMap({len(self.values)} values, {self.name!r}, range={self.range})"

    def keys(self, column: str) -> dict[str, Any]:
        """Returns the keys of [points.color]."""
        keys = {"column": column, "map": self.name, "range": self.range, "nan_color": self.nan_color}
        return {key: value for key, value in keys.items() if value is not None}


def colormap(
    values: ArrayLike,
    name: Path = "viridis",
    range: Sequence[float] | None = None,
    nan_color: Vector | None = None,
) -> ColorMap:
    """Returns colours for Scene.add_points(): one value per position, shown by a colour map.

    values     shape (n,): numbers, or strings, of which each has its own colour
    name       one of orrery.color_maps, or a file, e.g. "map.txt"
    range      values at the ends of the map; by default the minimum and the maximum
    nan_color  linear colour of values that are NaN; by default grey
    """
    array = _arrays.numbers_or_strings(values, "values")
    if array.ndim != 1:
        raise ValueError(f"values must have the shape (n,), not {array.shape}")
    name = _arguments.path("name", name)
    if os.path.exists(name) and name not in _orrery.color_map_names():
        name = os.path.abspath(name)
    out = ColorMap(array, name, range, nan_color)
    keys = {"file": "positions", "material": "matte", "radius": 1, "color": out.keys("x")}
    columns = dict.fromkeys("xyz", np.empty(0))
    _keys.check_table("colormap()", _keys.table_text("points", keys), "matte", file="positions", columns=columns)
    return out


class Points(Mapping[str, Any]):
    """The columns of a data file by name, as arrays; strings are lists. See read_points()."""

    def __init__(self, columns: dict[str, Any], described: dict[str, Any]) -> None:
        self._columns = columns
        self._described = described

    def __getitem__(self, column: str) -> Any:
        if column not in self._columns:
            raise KeyError(f"no column `{column}`; the columns are {', '.join(self._columns)}")
        return self._columns[column]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self):
        rows = max((len(column) for column in self._columns.values()), default=0)
        return f"Points({rows} rows: {', '.join(self._columns)})"

    @property
    def positions(self) -> NDArray[Any]:
        """Positions, shape (n, 3): a new array in the type of the file."""
        return np.stack([self[column] for column in self._described["position"]], axis=1)

    @property
    def radius(self) -> NDArray[Any] | None:
        """Radii, shape (n,); None if the file has none. Diameters are halved."""
        column, scale = self._described["radius"], self._described["radius_scale"]
        if column is None:
            return None
        return self[column] if scale == 1 else self[column] * scale

    @property
    def frames(self) -> int:
        """Number of frames of the file."""
        return self._described["frames"]

    @property
    def step(self) -> float | None:
        """Time step or number of the frame; None if the file has none."""
        return self._described["step"]

    @property
    def title(self) -> str:
        """Title or comment of the file."""
        return self._described["title"]

    @property
    def box(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]] | None:
        """Simulation box: origin (3,), edges (3, 3) by rows, and which are periodic; None if the file has none."""
        if self._described["box"] is None:
            return None
        origin, edges, periodic = self._described["box"]
        return np.array(origin), np.array(edges), np.array(periodic)


def read_points(
    file: Path,
    *,
    frame: int = 1,
    component: int | None = None,
    columns: Iterable[str] | None = None,
    topology: Path | None = None,
) -> Points:
    """Reads a data file: LAMMPS, XYZ, PDB, mmCIF, CIF, VASP, GRO, XTC, TRR, DCD and others (docs/data.md).

    frame      number of the frame, from 1
    component  HDF5 snapshots: particle type
    columns    names of the columns to read; by default all
    topology   trajectories: data file that names the atoms
    """
    file, frame = _arguments.path("file", file), _arguments.whole("frame", frame)
    component = None if component is None else _arguments.whole("component", component)
    names = [_arguments.text("a name in columns", name) for name in columns or []]
    topology = "" if topology is None else _arguments.path("topology", topology)
    return Points(*_orrery.read_points(file, frame, component, names, topology))
