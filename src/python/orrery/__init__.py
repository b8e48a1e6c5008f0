# SPDX-License-Identifier: Apache-2.0
"""Path tracing of scenes made of spheres, from NumPy arrays.

    import numpy as np, orrery
    positions = np.random.default_rng(1).normal(size=(1000, 3))
    scene = orrery.Scene(camera=orrery.Camera.fit(positions), background=orrery.Constant(1))
    scene.add_points(positions, radius=0.1)
    scene.render(640, 360, noise=0.05).write("out.png")

    orrery.plot("melt.dump", color_by="speed").write("melt.png")
    orrery.movie("pour.dump", "pour.mp4", color_by="speed")

The keys of scenes, their units and their defaults are those of scene files (docs/scene-format.md).
"""

from orrery import _processor  # noqa: F401  before the extension module
from orrery._errors import Error, MissingInputError, OutOfMemoryError, OutputError, SceneError, SceneWarning, UsageError
from orrery import _keys
from orrery._keys import *  # noqa: F403
from orrery._orrery import color_map_names as _color_map_names
from orrery._orrery import version as _version
from orrery._movie import Movie, movie
from orrery._picture import Picture
from orrery._plot import plot
from orrery._points import ColorMap, Points, colormap, read_points
from orrery._scene import Progress, Scene, load
from orrery._view import View

__all__ = [
    "ColorMap", "Error", "MissingInputError", "Movie", "OutOfMemoryError", "OutputError", "Picture", "Points", "Progress",
    "Scene", "SceneError", "SceneWarning", "UsageError", "View", "color_maps", "colormap", "load", "movie", "plot",
    "read_points",
]  # fmt: skip
__all__ += _keys.__all__

__version__: str = _version()

color_maps: tuple[str, ...] = tuple(_color_map_names())
