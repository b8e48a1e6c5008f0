# SPDX-License-Identifier: Apache-2.0
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Path = str | PathLike[str]
_Vector = Sequence[float] | NDArray[np.floating[Any]]
_Color = float | _Vector
_Texture = Mapping[str, Any]

__version__: str
color_maps: tuple[str, ...]

class Error(Exception):
    exit_status: int

class UsageError(Error, ValueError): ...
class SceneError(Error, ValueError): ...
class MissingInputError(Error, FileNotFoundError): ...
class OutputError(Error, OSError): ...
class OutOfMemoryError(Error, MemoryError): ...
class SceneWarning(UserWarning): ...

class _Keys:
    keys: dict[str, Any]

class Camera(_Keys):
    def __init__(
        self,
        look_from: _Vector | None = None,
        look_at: _Vector | None = None,
        *,
        vfov: float | None = None,
        up: _Vector | None = None,
        **keys: Any,
    ) -> None: ...
    @classmethod
    def fit(
        cls,
        positions: ArrayLike,
        radius: float | None = None,
        *,
        look_from: str = "iso",
        up: Literal["x", "y", "z"] = "z",
    ) -> Camera: ...
    def keys_for(self, aspect: float, radius: float = 0.0, vfov: float | None = None) -> dict[str, Any]: ...

class Constant(_Keys):
    def __init__(self, color: _Color | None = None, **keys: Any) -> None: ...

class Gradient(_Keys):
    def __init__(self, bottom: _Color | None = None, top: _Color | None = None, **keys: Any) -> None: ...

class Image(_Keys):
    def __init__(
        self, file: _Path, *, rotation: float | None = None, exposure: float | None = None, **keys: Any
    ) -> None: ...

class Sky(_Keys):
    def __init__(
        self,
        sun_elevation: float | None = None,
        sun_azimuth: float | None = None,
        *,
        turbidity: float | None = None,
        **keys: Any,
    ) -> None: ...

class Lambertian(_Keys):
    def __init__(self, albedo: _Color | _Texture | None = None, **keys: Any) -> None: ...

class Hemisphere(_Keys):
    def __init__(self, albedo: _Color | _Texture | None = None, **keys: Any) -> None: ...

class Metal(_Keys):
    def __init__(
        self, albedo: _Color | _Texture | None = None, fuzz: float | _Texture | None = None, **keys: Any
    ) -> None: ...

class Dielectric(_Keys):
    def __init__(self, ior: float | None = None, *, fuzz: float | _Texture | None = None, **keys: Any) -> None: ...

class Emitter(_Keys):
    def __init__(
        self, radiance: _Color | _Texture | None = None, exposure: float | None = None, **keys: Any
    ) -> None: ...

class ColorMap:
    values: NDArray[Any]
    name: str
    range: Sequence[float] | None
    nan_color: _Vector | None
    def __init__(
        self, values: NDArray[Any], name: str, range: Sequence[float] | None, nan_color: _Vector | None
    ) -> None: ...
    def keys(self, column: str) -> dict[str, Any]: ...

def colormap(
    values: ArrayLike,
    name: _Path = "viridis",
    range: Sequence[float] | None = None,
    nan_color: _Vector | None = None,
) -> ColorMap: ...

class Points(Mapping[str, Any]):
    def __init__(self, columns: dict[str, Any], described: dict[str, Any]) -> None: ...
    def __getitem__(self, column: str) -> Any: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...
    @property
    def positions(self) -> NDArray[Any]: ...
    @property
    def radius(self) -> NDArray[Any] | None: ...
    @property
    def frames(self) -> int: ...
    @property
    def step(self) -> float | None: ...
    @property
    def title(self) -> str: ...
    @property
    def box(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]] | None: ...

def read_points(
    file: _Path, *, frame: int = 1, component: int | None = None, columns: Iterable[str] | None = None
) -> Points: ...

class Picture:
    def __init__(self, native: Any) -> None: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def layers(self) -> tuple[str, ...]: ...
    @property
    def beauty(self) -> NDArray[np.float32]: ...
    @property
    def statistics(self) -> dict[str, Any]: ...
    def __getitem__(self, name: str) -> NDArray[np.float32]: ...
    def __contains__(self, name: str) -> bool: ...
    def write(
        self,
        *files: _Path,
        bits: Literal[0, 8, 16] = 0,
        type: Literal["half", "float"] = "half",
        compression: str = "",
        multipart: bool = False,
        reproducible: bool = False,
        display: str | None = None,
        view: str | None = None,
        look: str | None = None,
        exposure: float | None = None,
    ) -> None: ...
    def to_srgb8(
        self,
        *,
        display: str | None = None,
        view: str | None = None,
        look: str | None = None,
        exposure: float | None = None,
    ) -> NDArray[np.uint8]: ...

class Progress(NamedTuple):
    fraction: float
    samples_done: int
    samples_total: int
    seconds: float
    goal: str

class Scene:
    def __init__(
        self,
        camera: Camera | None = None,
        background: Constant | Gradient | Image | Sky | None = None,
        materials: Mapping[str, Lambertian | Hemisphere | Metal | Dielectric | Emitter] | None = None,
    ) -> None: ...
    def set(self, key: str, value: Any) -> None: ...
    def add_material(self, name: str, material: Lambertian | Hemisphere | Metal | Dielectric | Emitter) -> None: ...
    def add_sphere(
        self,
        center: _Vector,
        radius: float,
        material: str = "matte",
        *,
        name: str | None = None,
        group: str | None = None,
    ) -> None: ...
    def add_points(
        self,
        positions: ArrayLike,
        radius: float | ArrayLike | Mapping[str, Any] | None = None,
        *,
        color: ColorMap | ArrayLike | Mapping[str, Any] | None = None,
        material: str = "matte",
        columns: Mapping[str, ArrayLike] | None = None,
        **keys: Any,
    ) -> None: ...
    def check(self) -> list[str]: ...
    def save(self, file: _Path) -> None: ...
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
    ) -> Picture: ...

def load(file: _Path) -> Scene: ...
