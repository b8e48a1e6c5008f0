# SPDX-License-Identifier: Apache-2.0
"""Scenes: the text of a scene file, settings that override it, and arrays in place of data files."""

import operator
import os
import re
import tomllib
import warnings
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from orrery import _arrays, _keys, _orrery
from orrery._errors import SceneWarning
from orrery._picture import Picture
from orrery._points import ColorMap

_NEW_SCENE = """[material.matte]
type = "lambertian"
albedo = [0.8, 0.8, 0.8]
"""


class Progress(NamedTuple):
    """Progress of a render."""

    fraction: float
    samples_done: int
    samples_total: int
    seconds: float
    goal: str


def load(file):
    """Returns the scene in a file. Keys and data files are checked when it is rendered, saved or checked."""
    scene = Scene()
    scene._file = os.fspath(file)
    scene._is_file = True
    scene._text = _orrery.read_scene_text(scene._file)
    return scene


class Scene:
    """A scene. All keys are those of scene files.

    camera      a Camera
    background  Constant, Gradient, Image or Sky
    materials   materials by name, besides "matte", a light grey

    Settings are checked when the scene is rendered, saved or checked. Arrays are not copied: they are read then, too.
    """

    def __init__(self, camera=None, background=None, materials=None):
        self._file = "scene"
        self._is_file = False
        self._text = _NEW_SCENE
        self._settings = {}
        self._arrays = {}
        if camera is not None:
            self.set("camera", camera)
        if background is not None:
            self.set("background", background)
        for name, material in (materials or {}).items():
            self.add_material(name, material)

    def __repr__(self):
        return f"Scene({self._file!r}, {len(self._settings)} settings, {len(self._arrays)} arrays of points)"

    def set(self, key, value):
        """Sets a key, as --set does: scene.set("camera.vfov", 30), scene.set("background", orrery.Constant(0)).

        A table, such as a Camera, replaces all keys of its name.
        """
        if not isinstance(key, str):
            raise TypeError(f"a key is text such as 'camera.vfov', not {key!r}")
        if isinstance(value, (_keys.Keys, Mapping)):
            for old in [old for old in self._settings if old.startswith(key + ".")]:
                del self._settings[old]
        if not isinstance(value, _keys.Camera):
            value = _keys.toml_text(value)
        self._settings.pop(key, None)  # the last one wins, at its place
        self._settings[key] = value

    def add_material(self, name, material):
        """Adds a material, or replaces the one with this name."""
        self.set("material." + _keys.toml_text(name), material)

    def add_sphere(self, center, radius, material="matte", *, name=None, group=None):
        """Adds a sphere. A negative radius turns the normal inward, for hollow glass."""
        self._add_table("sphere", dict(center=center, radius=radius, material=material, name=name, group=group))

    def add_points(self, positions, radius=None, *, color=None, material="matte", columns=None, **keys):
        """Adds a sphere per position.

        positions  shape (n, 3); float64 and float32 are read without a copy, in any layout
        radius     a number, or an array of shape (n,), or keys such as {"column": "mass", "scale": 0.1}
        color      a colormap(), or display-referred sRGB: shape (3,) or (n, 3), from 0 to 1, or integers to 255;
                   by default the colour of the material
        columns    further arrays of shape (n,) by name, for keys that name columns
        keys       of [[points]]: select, clip, transform, name, group ...
        """
        positions = _arrays.positions(positions)
        rows = len(positions)
        table = dict(zip("xyz", positions.T))
        for name, values in (columns or {}).items():
            if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name):
                raise ValueError(f"{name!r} is not a name for a column; use letters, digits and _")
            _add_column(table, name, _arrays.column(values, name, rows))
        keys["material"] = material
        if radius is not None:
            keys["radius"] = _radius(radius, rows, table)
        if color is not None:
            keys["color"] = _color(color, rows, table)
        name = self._new_name()
        # Cryptomatte names spheres after their file, which is another one in a scene that was saved.
        self._add_table("points", {"file": name, "name": name, **keys})
        self._arrays[name] = list(table.items())

    def check(self):
        """Reads the scene and checks everything that a render would reject. Returns the warnings."""
        return self._data().check()

    def save(self, file):
        """Writes a scene file, and a PLY file beside it for each add_points(). Both read back without loss.

        Comments of a loaded scene are not kept. No file that the scene reads is replaced.
        """
        self._data().save(os.fspath(file))

    def render(
        self,
        width=None,
        height=None,
        *,
        samples=None,
        noise=None,
        time=None,
        threads=None,
        frame=1,
        memory_limit=None,
        on_progress=None,
    ):
        """Renders the scene and returns a Picture, with the same bits as `orrery render`.

        width, height  pixels; by default the scene's
        samples        per pixel; by default the scene's, or, with noise or time, as many as needed
        noise          target noise (relative display error), e.g. 0.02
        time           time budget for adaptive sampling, seconds
        threads        by default all CPUs available to the process
        frame          of an animation
        memory_limit   bytes; by default the free memory
        on_progress    called with a Progress, at most ten times a second

        Other Python threads run meanwhile. KeyboardInterrupt, and an exception in on_progress, stop the render.
        """
        sizes = [_whole("width", width), _whole("height", height)]
        data = self._data(*sizes, _whole("samples", samples), _whole("frame", frame))
        limits = [_limit("noise", noise, 1e-6, 1), _limit("time", time, 1e-3, 1e9)]
        threads = _limit("threads", _whole("threads", threads), 1, 1024)
        memory = int(_limit("memory_limit", memory_limit, 1, 2**63))

        def report(*values):
            on_progress(Progress(*values))

        def warn(text):
            warnings.warn(text.rstrip("\n"), SceneWarning, stacklevel=3)

        return Picture(data.render(*limits, threads, memory, "", report if on_progress else None, warn))

    def _add_table(self, name, keys):
        lines = [f"{key} = {_keys.toml_text(value)}\n" for key, value in keys.items() if value is not None]
        self._text += ("" if self._text.endswith("\n") else "\n") + f"\n[[{name}]]\n" + "".join(lines)

    def _new_name(self):
        """Returns a name for arrays that the scene does not use for a file."""
        number = len(self._arrays) + 1
        while f"positions-{number}" in self._text:
            number += 1
        return f"positions-{number}"

    def _image_size(self):
        """Returns the width and height of the scene's image, as far as they are valid."""
        try:
            image = dict(tomllib.loads(self._text).get("image", {}))
        except (tomllib.TOMLDecodeError, TypeError, ValueError):
            image = {}
        for key, value in self._settings.items():
            if key in ("image.width", "image.height") and value.isdigit():
                image[key[6:]] = int(value)
        sizes = [image.get("width", 1200), image.get("height", 675)]
        return [size if isinstance(size, int) and size > 0 else 1 for size in sizes]

    def _data(self, width=None, height=None, samples=None, frame=1):
        sizes = self._image_size()
        own = {"image.width": width, "image.height": height, "render.samples": samples}
        overrides = []
        for key, value in self._settings.items():
            if isinstance(value, _keys.Camera):
                value = _keys.toml_text(value.keys_for((width or sizes[0]) / (height or sizes[1])))
            overrides.append(f"{key}={value}")
        overrides += [f"{key}={_keys.toml_text(value)}" for key, value in own.items() if value is not None]
        data = _orrery.SceneData(self._file, self._is_file, self._text, overrides, frame)
        for name, columns in self._arrays.items():
            data.add_table(name, columns)
        return data


def _limit(name, value, low, high):
    """Returns a limit of a render; 0 if it is not set."""
    if value is None:
        return 0
    if not _keys.is_number(value) or not low <= value <= high:
        raise ValueError(f"{name} is {value!r}; must be in [{low:g}, {high:g}]")
    return value


def _whole(name, value):
    """Returns an integer, or None."""
    try:
        return None if value is None else operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is {value!r}; must be an integer") from None


def _add_column(table, name, values):
    if name in table:
        raise ValueError(f"there is a column {name!r} already")
    table[name] = values


def _radius(radius, rows, table):
    if isinstance(radius, (str, Mapping)) or np.ndim(radius) == 0:
        return radius if isinstance(radius, Mapping) else np.asarray(radius).item()
    _add_column(table, "radius", _arrays.column(radius, "radius", rows))
    return {"column": "radius"}


def _color(color, rows, table):
    if isinstance(color, Mapping):
        return color
    if isinstance(color, ColorMap):
        _add_column(table, "color", _arrays.column(color.values, "the values of the colour map", rows))
        return color.keys("color")
    array = _arrays.numbers(color, "color")
    if array.shape == (3,):
        array = np.broadcast_to(array, (rows, 3))
    if array.shape != (rows, 3):
        raise ValueError(f"color must have the shape (3,) or ({rows}, 3), not {array.shape}")
    for name, values in zip(("red", "green", "blue"), array.T):
        _add_column(table, name, values)
    return {"rgb": True}
