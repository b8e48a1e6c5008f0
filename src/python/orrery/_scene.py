# SPDX-License-Identifier: Apache-2.0
"""Scenes: the text of a scene file, settings that override it, and arrays in place of data files."""

from __future__ import annotations

import copy
import math
import re
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from orrery import _arguments, _arrays, _keys, _orrery
from orrery._arguments import Path, Vector
from orrery._errors import SceneWarning
from orrery._keys import Background, Camera, Material
from orrery._picture import Picture
from orrery._points import ColorMap
from orrery._view import View

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


def load(file: Path) -> Scene:
    """Returns the scene in a file. Keys and data files are checked when it is rendered, saved or checked."""
    scene = Scene()
    scene._file = _arguments.path("file", file)
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

    def __init__(
        self,
        camera: Camera | None = None,
        background: Background | None = None,
        materials: Mapping[str, Material] | None = None,
    ) -> None:
        self._file = "scene"
        self._is_file = False
        self._text = _NEW_SCENE  # of the scene file
        self._tables = []  # texts of [[sphere]], [[rod]] and [[points]] that were added to it
        self._settings = {}
        self._parents = set()  # keys of tables of which single keys are set
        self._arrays = {}
        self._prepared = _orrery.Prepared()  # what renders of this scene share
        self._radii = {}  # of the arrays; None if they are not a number for all
        if camera is not None:
            self.set("camera", camera)
        if background is not None:
            self.set("background", background)
        for name, material in (materials or {}).items():
            self.add_material(name, material)

    def __repr__(self):
        return f"Scene({self._file!r}, {len(self._settings)} settings, {len(self._arrays)} arrays of points)"

    def __copy__(self):
        """A separate scene with the same arrays."""
        out = object.__new__(type(self))
        out.__dict__.update((name, copy.copy(value)) for name, value in self.__dict__.items())
        return out

    def set(self, key: str, value: Any) -> None:
        """Sets a key, as --set does: scene.set("camera.vfov", 30), scene.set("background", orrery.Constant(0)).

        A table, such as a Camera, replaces all keys of its name. None removes the setting.
        """
        key = _arguments.text("key", key)
        if value is not None and not isinstance(value, _keys.Camera):
            value = _keys.toml_text(value)
        if key in self._parents and (value is None or value[:1] == "{" or isinstance(value, _keys.Camera)):
            for old in [old for old in self._settings if old.startswith(key + ".")]:
                del self._settings[old]
        self._settings.pop(key, None)  # the last one wins, at its place
        if value is not None:
            self._settings[key] = value
            self._parents.update(key[: dot.start()] for dot in re.finditer(r"\.", key))

    def add_material(self, name: str, material: Material) -> None:
        """Adds a material, or replaces the one with this name."""
        self.set("material." + _keys.toml_text(name), material)

    def add_sphere(
        self,
        center: Vector,
        radius: float,
        material: str = "matte",
        *,
        name: str | None = None,
        group: str | None = None,
    ) -> None:
        """Adds a sphere. A negative radius turns the normal inward, for hollow glass."""
        keys = {"center": center, "radius": radius, "material": material, "name": name, "group": group}
        text = _keys.table_text("sphere", keys)
        if not _is_ordinary(center, radius, material, name, group):
            _keys.check_table("add_sphere()", text, material)
        self._tables.append(text)

    def add_rod(
        self,
        start: Vector,
        end: Vector,
        radius: float,
        material: str | Sequence[str] = "matte",
        *,
        name: str | None = None,
        group: str | None = None,
    ) -> None:
        """Adds a rod: a sphere swept along a segment. Two materials are those of the halves at start and at end."""
        keys = {"from": start, "to": end, "radius": radius, "material": material, "name": name, "group": group}
        text = _keys.table_text("rod", keys)
        _keys.check_table("add_rod()", text, *(material if isinstance(material, (tuple, list)) else [material]))
        self._tables.append(text)

    def add_points(
        self,
        positions: ArrayLike,
        radius: float | ArrayLike | Mapping[str, Any] | None = None,
        *,
        color: ColorMap | ArrayLike | Mapping[str, Any] | None = None,
        opacity: float | ArrayLike | Mapping[str, Any] | None = None,
        material: str = "matte",
        columns: Mapping[str, ArrayLike] | None = None,
        **keys: Any,
    ) -> None:
        """Adds a sphere per position.

        Keys and names are checked at once, values of arrays when the scene is rendered, saved or checked.

        positions  shape (n, 3); float64 and float32 are read without a copy, in any layout
        radius     a number, or an array of shape (n,), or keys such as {"column": "mass", "scale": 0.1}
        color      a colormap(), or display-referred sRGB: shape (3,) or (n, 3), from 0 to 1, or integers to 255;
                   by default the colour of the material
        opacity    from 0 to 1: a number, or an array of shape (n,), or keys such as {"where": ["x > 1: 0.2"]}; by
                   default that of the material
        columns    further arrays of shape (n,) by name, for keys that name columns: numbers, or strings, which are copied
        keys       of [[points]]: select, clip, transform, name, group ...
        """
        positions = _arrays.positions(positions)
        rows = len(positions)
        table = dict(zip("xyz", positions.T))
        for name, values in dict(columns or {}).items():
            if not re.fullmatch(r"[^\x00-\x1f\x7f]+", _arguments.text("a name in columns", name)):
                raise ValueError(f"{name!r} is not a name for a column; names have no control characters")
            _arrays.add_column(table, name, _arrays.column(values, name, rows))
        if "file" in keys:
            raise TypeError("add_points() has no key 'file'; set radius, color or columns, or read_points(file)")
        keys["material"] = material
        if radius is not None:
            keys["radius"] = _numbers("radius", radius, rows, table)
        if opacity is not None:
            keys["opacity"] = _numbers("opacity", opacity, rows, table)
        if color is not None:
            keys["color"] = _color(color, rows, table)
        name = self._new_name()
        # Cryptomatte names spheres after their file, which is another one in a scene that was saved.
        text = _keys.table_text("points", {"file": name, "name": name, **keys})
        by_rule = [str(rule).rpartition(":")[2].strip() for rule in keys.get("material_where") or ()]
        _keys.check_table("add_points()", text, material, *by_rule, file=name, columns=table)
        self._tables.append(text)
        self._arrays[name] = table
        value = keys.get("radius")
        is_one = _keys.is_number(value) and math.isfinite(value) and "transform" not in keys
        self._radii[name] = abs(float(value)) if is_one else None

    def check(self) -> list[str]:
        """Reads the scene and checks everything that a render would reject. Returns the warnings."""
        return self._data().check()

    def save(self, file: Path) -> None:
        """Writes a scene file, and next to it a PLY file for each add_points(), or an NPY file if that has strings
        or names with spaces.

        Both read back without loss. Comments of a loaded scene are not kept. No file that the scene reads is replaced.
        """
        self._data().save(_arguments.path("file", file))

    def render(
        self,
        width: int | None = None,
        height: int | None = None,
        *,
        samples: int | None = None,
        noise: float | None = None,
        time: float | None = None,
        threads: int | None = None,
        frame: int = 1,
        memory_limit: int | None = None,
        denoise: bool = False,
        on_progress: Callable[[Progress], object] | None = None,
    ) -> Picture:
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

        The scene keeps what it has prepared: a further render reads and builds only what has changed since, such as a
        material or the camera.

        Other Python threads can run in the meantime. KeyboardInterrupt, and an exception in on_progress, stop the render.
        """
        counts = _counts(width, height, samples)
        frame = _arguments.whole("frame", frame)
        targets = [_limit("noise", noise, 1e-6, 1), _limit("time", time, 1e-3, 1e9)]
        (threads, memory), report = _limits(threads, memory_limit, on_progress)
        data = self._data(*counts, frame, memory)

        def warn(text):
            warnings.warn(text.rstrip("\n"), SceneWarning, stacklevel=3)

        return Picture(data.render(self._prepared, *targets, threads, memory, bool(denoise), report, warn))

    def view(
        self,
        width: int | None = None,
        height: int | None = None,
        *,
        samples: int | None = None,
        noise: float | None = None,
        threads: int | None = None,
        frame: int = 1,
        memory_limit: int | None = None,
        denoise: bool = False,
        port: int = 0,
        page_height: int = 720,
    ) -> View:
        """Returns a View: a page in a browser in which the scene can be turned, as `orrery view` shows files.

        port           of the page, on 127.0.0.1; 0: a free one
        page_height    in a notebook, in pixels
        others         as for render(); the page can change samples, noise, denoise and size

        A notebook shows the page if the browser runs on the same machine, or reaches the port through a tunnel.
        """
        width, height, samples = _counts(width, height, samples)
        noise = None if noise is None else _limit("noise", noise, 1e-6, 1)
        (threads, memory), _ = _limits(threads, memory_limit, None)
        data = self._data(width, height, None, _arguments.whole("frame", frame), memory)
        options = {"--width": width, "--height": height, "--samples": samples, "--noise": noise}
        options = {name: repr(value) for name, value in options.items() if value is not None}
        if denoise:
            options["--denoise"] = "on"
        port = _arguments.whole("port", port, 0, 65535)
        page_height = _arguments.whole("page_height", page_height, 100, 10000)
        page = _orrery.ScenePage(data, str(self._file), options, port, threads, memory)
        return View(page, (dict(self._arrays), data), page_height)

    def _new_name(self):
        """Returns a name for arrays that the scene does not use for a file."""
        number = len(self._arrays) + 1
        while f"positions-{number}" in self._text:
            number += 1
        return f"positions-{number}"

    def _vfov(self):
        """Returns the vertical field of view that is set in place of a fitted camera's projection; None if it is not."""
        try:
            vfov = float(self._settings.get("camera.vfov", "nan"))
        except ValueError:  # reported when the scene is read
            vfov = math.nan
        return vfov if 0 < vfov < 180 and "camera.projection" not in self._settings else None

    def _data(self, width=None, height=None, samples=None, frame=1, memory_limit=0):
        own = {"image.width": width, "image.height": height, "render.samples": samples}
        own = {key: _keys.toml_text(value) for key, value in own.items() if value is not None}
        lines = self._text.count("\n") + 1 if self._is_file else 0
        text = "\n".join([self._text, *self._tables])

        def data(camera):
            settings = {**self._settings, "camera": camera} if camera else self._settings
            overrides = [f"{key}={value}" for key, value in [*settings.items(), *own.items()]]
            out = _orrery.SceneData(self._file, self._is_file, text, lines, overrides, frame)
            for name, table in self._arrays.items():
                out.add_table(name, _arrays.native(table))
            return out

        camera = self._settings.get("camera")
        if not isinstance(camera, _keys.Camera):
            return data(None)
        unfitted = data(_keys.toml_text(camera.keys))
        if camera._extent is None:
            return unfitted
        radius = self._uniform_radius() if camera._completes_radius else 0.0
        if radius is None:
            radius = unfitted.largest_radius(memory_limit)
        return data(_keys.toml_text(camera.keys_for(unfitted.aspect(), radius, self._vfov())))

    def _uniform_radius(self):
        """Returns the largest radius of the points if it is known without reading them, or None."""
        if self._is_file or None in self._radii.values() or any(key.startswith("points") for key in self._settings):
            return None
        return max(self._radii.values(), default=0.0)


def _is_ordinary(center, radius, material, name, group):
    """Returns whether a sphere is certainly valid, because the reader takes 0.1 ms to find out."""
    numbers = [*center, radius, 1, 1] if isinstance(center, (tuple, list, np.ndarray)) else []
    return (
        len(numbers) == 6
        and all(_keys.is_number(x) and abs(x) < 1e9 for x in numbers)
        and abs(radius) > 1e-9
        and all(isinstance(word, str) for word in (material, name or "", group or ""))
    )


def _limit(name, value, low, high):
    """Returns a limit of a render; 0 if it is not set."""
    return 0 if value is None else _arguments.number(name, value, low, high)


def _limits(threads, memory_limit, on_progress):
    """Returns threads and memory limit, and the function that receives progress, as the extension module takes them."""
    threads = 0 if threads is None else _arguments.whole("threads", threads, 1, 1024)
    memory = int(_limit("memory_limit", memory_limit, 1, 2**63))
    if on_progress is not None and not callable(on_progress):
        raise TypeError(f"on_progress is {on_progress!r}; must be a function")

    def report(*values):
        on_progress(Progress(*values))

    return (threads, memory), report if on_progress else None


def _counts(width, height, samples):
    """Returns integers; None stays."""
    values = {"width": width, "height": height, "samples": samples}
    return [None if value is None else _arguments.whole(name, value) for name, value in values.items()]


def _numbers(key, value, rows, table):
    if isinstance(value, (str, Mapping)) or np.ndim(value) == 0:
        return value if isinstance(value, Mapping) else np.asarray(value).item()
    _arrays.add_column(table, key, _arrays.column(value, key, rows))
    return {"column": key}


def _color(color, rows, table):
    if isinstance(color, Mapping):
        return color
    if isinstance(color, ColorMap):
        _arrays.add_column(table, "color", _arrays.column(color.values, "the values of the colour map", rows))
        return color.keys("color")
    array = _arrays.numbers(color, "color")
    if array.shape == (3,):
        array = np.broadcast_to(array, (rows, 3))
    if array.shape != (rows, 3):
        raise ValueError(f"color must have the shape (3,) or ({rows}, 3), not {array.shape}")
    for name, values in zip(("red", "green", "blue"), array.T):
        _arrays.add_column(table, name, values)
    return {"rgb": True}
