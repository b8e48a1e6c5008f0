# SPDX-License-Identifier: Apache-2.0
"""Rendered images."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from orrery import _arguments, _orrery
from orrery._arguments import Path


def _display(display, view, look, exposure):
    names = {"display": display, "view": view, "look": look}
    texts = ["" if value is None else _arguments.text(name, value) for name, value in names.items()]
    stops = None if exposure is None else _arguments.number("exposure", exposure, -1e4, 1e4)
    return _orrery.Display(*texts, stops)


class Picture:
    """A rendered image: scene-linear float32 arrays, read-only, without a copy. Rows are from the top.

    picture["Z"], picture["N"], picture["CryptoObject00"] are layers of [output]; layers of one channel have the shape
    (height, width), others (height, width, channels). picture["R"] and picture["N.X"] are single channels. Arrays remain valid after the picture is deleted.
    """

    def __init__(self, native: Any, notes: Sequence[str] = ()) -> None:
        self._native = native
        self._notes = tuple(notes)

    def __repr__(self):
        return f"Picture({self.width} x {self.height}{''.join(', ' + layer for layer in self.layers)})"

    @property
    def width(self) -> int:
        """Pixels."""
        return self._native.width

    @property
    def height(self) -> int:
        """Pixels."""
        return self._native.height

    @property
    def layers(self) -> tuple[str, ...]:
        """Names of the layers other than the beauty."""
        return tuple(self._native.layers)

    @property
    def notes(self) -> tuple[str, ...]:
        """What plot() chose from the data, and the reasons; empty for other pictures."""
        return self._notes

    @property
    def beauty(self) -> NDArray[np.float32]:
        """Red, green, blue and alpha: shape (height, width, 4)."""
        return self._native.array("")

    @property
    def statistics(self) -> dict[str, Any]:
        """Statistics of the render: spheres, paths, rays, samples, noise, threads, and seconds of its phases."""
        return self._native.statistics()

    def __getitem__(self, name: str) -> NDArray[np.float32]:
        if not isinstance(name, str):
            raise TypeError(f"layers have names, not {name!r}; pixels are picture.beauty[row, column]")
        _arguments.text("name", name)
        array = self._native.array(name) if name else None
        if array is not None:
            return array
        layer, _, channel = name.rpartition(".")
        channels = self._native.channels(layer)
        if channel in channels and channel != layer:
            array = self._native.array(layer)
            return array if array.ndim == 2 else array[..., channels.index(channel)]
        raise KeyError(f"no layer `{name}`; the layers are {', '.join(self.layers) or 'none: set output.layers'}")

    def __contains__(self, name: str) -> bool:
        return name in self.layers

    def write(
        self,
        *files: Path,
        bits: Literal[0, 8, 16] = 0,
        type: Literal["half", "float"] = "half",
        compression: str = "",
        multipart: bool = False,
        reproducible: bool = False,
        display: str | None = None,
        view: str | None = None,
        look: str | None = None,
        exposure: float | None = None,
    ) -> None:
        """Writes image files, the same files that `orrery render` writes. The extension selects the format.

        bits          per channel of PNG and TIFF: 8 or 16
        type          of colours in an EXR: "half" or "float"
        compression   of an EXR, e.g. "zip"
        multipart     one part per layer in an EXR
        reproducible  omit everything from the header that varies between runs
        display, view, look, exposure   display transform; by default the scene's
        """
        if type not in ("half", "float"):
            raise ValueError(f'type must be "half" or "float", not {type!r}')
        if bits not in (0, 8, 16):
            raise ValueError(f"bits must be 8 or 16, not {bits}")
        if not files:
            raise TypeError("write() needs a file name")
        settings = _display(display, view, look, exposure)
        names = [_arguments.path("file", file) for file in files]
        compression = _arguments.text("compression", compression)
        self._native.write(
            names, bits, settings, type == "float", compression, bool(multipart), bool(reproducible)
        )

    def to_srgb8(
        self,
        *,
        display: str | None = None,
        view: str | None = None,
        look: str | None = None,
        exposure: float | None = None,
    ) -> NDArray[np.uint8]:
        """Returns the image for an sRGB display: uint8, shape (height, width, 3), or 4 with a transparent background.

        The values are those of a PNG. The display transform is the scene's; exposure is in stops.
        """
        return self._native.srgb8(_display(display, view, look, exposure))

    def _repr_png_(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "picture.png")
            self.write(file)
            with open(file, "rb") as png:
                return png.read()
