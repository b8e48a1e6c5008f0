# SPDX-License-Identifier: Apache-2.0
"""Scenes: the text of a scene file, settings that override it, and arrays in place of data files."""

import math
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
    materials   materials by name, in addition to "matte", a light grey

    Settings are checked when the scene is rendered, saved or checked. Arrays are not copied; they are read at the same time.
    """

    def __init__(self, camera=None, background=None, materials=None):
        self._file = "scene"
        self._is_file = False
        self._text = _NEW_SCENE
        self._settings = {}
        self._arrays = {}
        self._radii = {}  # of the arrays; None if they are not a number for all
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
        value = keys.get("radius")
        is_one = _keys.is_number(value) and math.isfinite(value) and "transform" not in keys
        self._radii[name] = abs(float(value)) if is_one else None

    def check(self):
        """Reads the scene and checks everything that a render would reject. Returns the warnings."""
        return self._data().check()

    def save(self, file):
        """Writes a scene file, and a PLY file next to it for each add_points(). Both read back without loss.

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
        denoise=False,
        on_progress=None,
    ):
        """Renders the scene and returns a Picture, with the same bits as `orrery render`.

        width, height  pixels; by default the scene's
        samples        per pixel; by default the scene's, or, with noise or time, as many as needed
        noise          target noise (relative display error), e.g. 0.02
        time           time budget for adaptive sampling, seconds
        threads        by default all CPUs available to the process
        frame          frame of the animation to render
        memory_limit   bytes; by default the free memory
        denoise        filters the beauty and the light layers, like `orrery render --denoise`
        on_progress    called with a Progress, at most ten times a second

        Other Python threads can run in the meantime. KeyboardInterrupt, and an exception in on_progress, stop the render.
        """
        sizes = [_whole("width", width), _whole("height", height)]
        samples, frame = _whole("samples", samples), _whole("frame", frame)
        limits = [_limit("noise", noise, 1e-6, 1), _limit("time", time, 1e-3, 1e9)]
        threads = _limit("threads", _whole("threads", threads), 1, 1024)
        memory = int(_limit("memory_limit", memory_limit, 1, 2**63))
        data = self._data(*sizes, samples, frame, memory)

        def report(*values):
            on_progress(Progress(*values))

        def warn(text):
            warnings.warn(text.rstrip("\n"), SceneWarning, stacklevel=3)

        return Picture(data.render(*limits, threads, memory, "", bool(denoise), report if on_progress else None, warn))

    def _add_table(self, name, keys):
        lines = [f"{key} = {_keys.toml_text(value)}\n" for key, value in keys.items() if value is not None]
        self._text += ("" if self._text.endswith("\n") else "\n") + f"\n[[{name}]]\n" + "".join(lines)

    def _new_name(self):
        """Returns a name for arrays that the scene does not use for a file."""
        number = len(self._arrays) + 1
        while f"positions-{number}" in self._text:
            number += 1
        return f"positions-{number}"

    def _table(self, name):
        """Returns the keys of a table such as "image", of the text and of the settings, as far as they are valid."""
        try:
            table = _table_of(tomllib.loads(self._text).get(name))
        except (tomllib.TOMLDecodeError, ValueError):
            table = {}
        for key, value in self._settings.items():
            if isinstance(value, str) and (key == name or key.startswith(name + ".")):
                try:
                    value = tomllib.loads(f"value = {value}")["value"]
                except (tomllib.TOMLDecodeError, ValueError):
                    continue
                if key == name:
                    table = _table_of(value)
                else:
                    table[key[len(name) + 1 :]] = value
        return table

    def _aspect(self, width, height):
        """Returns the width of the image divided by its height, as displayed; of keys that are not valid any number."""
        image = self._table("image")
        sides = width or image.get("width", 1200), height or image.get("height", 675), image.get("pixel_aspect", 1)
        width, height, pixel = (n if _keys.is_number(n) and 0 < n < math.inf else 1 for n in sides)
        return width / height * pixel

    def _data(self, width=None, height=None, samples=None, frame=1, memory_limit=0):
        own = {"image.width": width, "image.height": height, "render.samples": samples}
        aspect = self._aspect(width, height)
        vfov = self._table("camera").get("vfov") if "camera.vfov" in self._settings else None
        if not _keys.is_number(vfov) or not 0 < vfov < 180 or "camera.projection" in self._settings:
            vfov = None

        def data(radius=0.0):
            overrides = []
            for key, value in self._settings.items():
                if isinstance(value, _keys.Camera):
                    value = _keys.toml_text(value.keys_for(aspect, radius, vfov))
                overrides.append(f"{key}={value}")
            overrides += [f"{key}={_keys.toml_text(value)}" for key, value in own.items() if value is not None]
            out = _orrery.SceneData(self._file, self._is_file, self._text, overrides, frame)
            for name, columns in self._arrays.items():
                out.add_table(name, columns)
            return out

        camera = self._settings.get("camera")
        if not isinstance(camera, _keys.Camera) or not camera._completes_radius:
            return data()
        radius = self._uniform_radius()
        return data(data().largest_radius(memory_limit) if radius is None else radius)

    def _uniform_radius(self):
        """Returns the largest radius of the points if it is known without reading them, or None."""
        if self._is_file or None in self._radii.values() or any(key.startswith("points") for key in self._settings):
            return None
        return max(self._radii.values(), default=0.0)


def _table_of(value):
    return dict(value) if isinstance(value, Mapping) else {}


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
