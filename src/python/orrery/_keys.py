# SPDX-License-Identifier: Apache-2.0
"""Tables of a scene file as objects, and values of a scene file as text."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable, Mapping
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from orrery import _arguments, _arrays
from orrery._arguments import Color, Path, Texture, Vector, is_number
from orrery._errors import Error
from orrery._orrery import Extent, SceneData

__all__ = [
    "Camera", "Constant", "Dielectric", "Emitter", "Gradient", "Hemisphere", "Image", "Lambertian", "Metal", "Plastic", "Sky",
]  # fmt: skip


def toml_text(value):
    """Returns a value as in a scene file, on one line."""
    if isinstance(value, Keys):
        value = value.keys
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, str):
        return json.dumps(_arguments.text("a string", value), ensure_ascii=False).replace("\x7f", "\\u007F")
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{toml_text(str(k))} = {toml_text(v)}" for k, v in value.items()) + "}"
    if isinstance(value, Iterable):
        return "[" + ", ".join(map(toml_text, value)) + "]"
    raise TypeError(f"a scene has no values of type {type(value).__name__}")


def table_text(name, keys):
    """Returns a table of an array of tables, such as [[sphere]]."""
    lines = [f"{key} = {toml_text(value)}\n" for key, value in keys.items() if value is not None]
    return f"\n[[{name}]]\n" + "".join(lines)


def check_table(call, text, *materials, file="", columns=None):
    """Checks the keys of a table, and the names of columns, but no values of arrays.

    call       name of the function, for messages
    materials  names of the materials, which may be defined later
    file      name of the columns in the text
    """
    names = dict.fromkeys(map(str, materials))
    text = "".join(f"[material.{toml_text(name)}]\ntype = 'lambertian'\nalbedo = [0, 0, 0]\n" for name in names) + text
    data = SceneData(call, False, text, 0, [], 1)
    if columns is not None:
        data.add_table(file, _arrays.native(columns, 0))
    try:
        data.check_keys()
    except Error as error:  # the index is another one in the scene
        error.args = (re.sub(r" in (points|sphere|rod)\[0\]|\b(points|sphere|rod)\[0\]\.", "", str(error)),)
        raise


def _color(value):
    """A number is a grey."""
    return [value] * 3 if is_number(value) else value


class Keys:
    """A table of a scene file. Keys that are None have their defaults."""

    def __init__(self, **keys: Any) -> None:
        self.keys = {key: value for key, value in keys.items() if value is not None}

    def __repr__(self):
        return f"{type(self).__name__}({', '.join(f'{k}={v!r}' for k, v in self.keys.items())})"


class Camera(Keys):
    """A camera, defined by the keys of [camera]: vfov in degrees, the rest in scene units.

    An orthographic camera has projection="orthographic" and a width.
    """

    def __init__(
        self,
        look_from: Vector | None = None,
        look_at: Vector | None = None,
        *,
        vfov: float | None = None,
        up: Vector | None = None,
        **keys: Any,
    ) -> None:
        super().__init__(look_from=look_from, look_at=look_at, vfov=vfov, up=up, **keys)
        self._extent = None
        self._completes_radius = False

    @classmethod
    def fit(
        cls,
        positions: ArrayLike,
        radius: float | None = None,
        *,
        look_from: str = "iso",
        up: Literal["x", "y", "z"] = "z",
    ) -> Camera:
        """Returns a camera that sees spheres around all positions in an image of any size, with a margin of 5 %.

        It is orthographic, or a perspective camera if "camera.vfov" of the scene is set.

        positions  shape (n, 3)
        radius     of the spheres; by default the largest radius of the scene's points when it is rendered or saved
        look_from  "iso", "+x", "-x" .. "-z", or "azimuth,elevation" in degrees, as for `orrery plot`
        up         "x", "y" or "z"
        """
        radius_or_0 = 0.0 if radius is None else _arguments.number("radius", radius, 0, 1e18)
        look_from, up = _arguments.text("look_from", look_from), _arguments.text("up", up)
        columns = _arrays.native(dict(zip("xyz", _arrays.positions(positions).T)))
        camera = cls()
        camera._extent = Extent(columns, radius_or_0, look_from, up)
        camera._completes_radius = radius is None
        camera.keys = camera.keys_for(16 / 9)
        return camera

    def keys_for(self, aspect: float, radius: float = 0.0, vfov: float | None = None) -> dict[str, Any]:
        """Returns the keys for an image of this aspect ratio; only those of a fitted camera depend on the arguments.

        aspect  width divided by height, as displayed
        radius  of the spheres, if fit() was not given one
        vfov    vertical field of view in degrees, for a perspective camera
        """
        if self._extent is None:
            return self.keys
        aspect = _arguments.number("aspect", aspect, 1e-9, 1e9)
        radius = _arguments.number("radius", radius, 0, 1e18) if self._completes_radius else 0.0
        return self._extent.camera(aspect, radius, None if vfov is None else _arguments.number("vfov", vfov, 0, 180))


class Constant(Keys):
    """A background of one colour, linear; a number is a grey."""

    def __init__(self, color: Color | None = None, **keys: Any) -> None:
        super().__init__(type="constant", color=_color(color), **keys)


class Gradient(Keys):
    """A background between two linear colours: straight down and straight up."""

    def __init__(self, bottom: Color | None = None, top: Color | None = None, **keys: Any) -> None:
        super().__init__(type="gradient", bottom=_color(bottom), top=_color(top), **keys)


class Image(Keys):
    """An image background: a latitude-longitude map in an EXR or HDR file, rotated in degrees, exposed in stops."""

    def __init__(
        self,
        file: Path,
        *,
        rotation: float | None = None,
        exposure: float | None = None,
        **keys: Any,
    ) -> None:
        super().__init__(type="image", file=file, rotation=rotation, exposure=exposure, **keys)


class Sky(Keys):
    """A daylight sky. Angles are in degrees; a turbidity of 1 is pure air."""

    def __init__(
        self,
        sun_elevation: float | None = None,
        sun_azimuth: float | None = None,
        *,
        turbidity: float | None = None,
        **keys: Any,
    ) -> None:
        super().__init__(
            type="sky", sun_elevation=sun_elevation, sun_azimuth=sun_azimuth, turbidity=turbidity, **keys
        )


class Lambertian(Keys):
    """A diffuse material. Its albedo is linear: a number is a grey, a dict is a texture."""

    def __init__(self, albedo: Color | Texture | None = None, **keys: Any) -> None:
        super().__init__(type="lambertian", albedo=_color(albedo), **keys)


class Hemisphere(Keys):
    """The first diffuse material of the book "Ray Tracing in One Weekend"; its albedo may be a texture."""

    def __init__(self, albedo: Color | Texture | None = None, **keys: Any) -> None:
        super().__init__(type="hemisphere", albedo=_color(albedo), **keys)


class Metal(Keys):
    """A metal; its fuzz is from 0, a mirror, to 1. Albedo and fuzz may be textures."""

    def __init__(self, albedo: Color | Texture | None = None, fuzz: float | Texture | None = None, **keys: Any) -> None:
        super().__init__(type="metal", albedo=_color(albedo), fuzz=fuzz, **keys)


class Dielectric(Keys):
    """Glass or water, by its index of refraction; its fuzz, a number or a texture, makes it rough."""

    def __init__(self, ior: float | None = None, *, fuzz: float | Texture | None = None, **keys: Any) -> None:
        super().__init__(type="dielectric", ior=ior, fuzz=fuzz, **keys)


class Emitter(Keys):
    """A light: emits the same linear radiance, which may be a texture, in all directions."""

    def __init__(self, radiance: Color | Texture | None = None, exposure: float | None = None, **keys: Any) -> None:
        super().__init__(type="emitter", radiance=_color(radiance), exposure=exposure, **keys)


class Plastic(Keys):
    """A clear coat over a diffuse base. Albedo, of the base, and fuzz, of the coat, may be textures."""

    def __init__(
        self,
        albedo: Color | Texture | None = None,
        *,
        ior: float | None = None,
        fuzz: float | Texture | None = None,
        **keys: Any,
    ) -> None:
        super().__init__(type="plastic", albedo=_color(albedo), ior=ior, fuzz=fuzz, **keys)


Background = Constant | Gradient | Image | Sky
Material = Lambertian | Hemisphere | Metal | Dielectric | Emitter | Plastic
