# SPDX-License-Identifier: Apache-2.0
"""movie(): films of particles, by the options of `orrery plot`."""

from __future__ import annotations

import base64
import dataclasses
import html
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from orrery import _arguments, _orrery
from orrery._arguments import Path
from orrery._plot import _named, _source, _warn, _words
from orrery._scene import Progress, _limits


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class Movie:
    """A film file that movie() has written. A notebook shows it.

    file    name of the file
    frames  numbers of the frames that it shows
    notes   what movie() chose from the data, and the reasons
    """

    file: str
    frames: tuple[int, ...]
    notes: tuple[str, ...]

    def __repr__(self):
        return f"Movie({self.file!r}, {len(self.frames)} frames)"

    def _repr_html_(self):
        with open(self.file, "rb") as film:
            data = base64.b64encode(film.read()).decode()
        if self.file.lower().endswith(".gif"):
            return f'<img src="data:image/gif;base64,{data}" alt="{html.escape(self.file)}">'
        return f'<video controls loop autoplay muted src="data:video/mp4;base64,{data}"></video>'


def movie(
    data: Any,
    file: Path,
    *,
    frames: str | Sequence[int] | None = None,
    turntable: float | None = None,
    fps: float = 24,
    keep_frames: bool = False,
    columns: Mapping[str, Any] | None = None,
    cell: Any = None,
    threads: int | None = None,
    memory_limit: int | None = None,
    on_progress: Callable[[Progress], object] | None = None,
    **options: Any,
) -> Movie:
    """Renders particles frame by frame and writes a film, with the same bits as `orrery plot -o film.mp4`.

    data           a data file with several frames, or a name like "pour.####.dump"; a trajectory: a sequence of what
                   plot() accepts, positions of shape (frames, n, 3), or an MDAnalysis Universe or AtomGroup; a
                   function that returns what plot() accepts for the number of a frame; or with `turntable` what plot()
                   accepts
    file           the film: .mp4 or .gif. The program ffmpeg must be installed
    frames         numbers of frames, from 1, or a text: "1-48", "10-94x6", "all"; default: all
    turntable      seconds of an orbit of the camera; without `frames`, the film shows one frame of the data
    fps            frames per second; a GIF has at most 50
    keep_frames    keep the images in the folder FILE.frames. Otherwise they stay only if the film is not finished, and
                   the next call continues from them
    columns, cell, threads, memory_limit, on_progress, options   as for plot(); columns apply to every frame

    The camera fits all frames, and the range of the colour map is the same in all of them. Data in memory are requested
    twice for each frame: to fit the camera, and to render.
    """
    name = _arguments.path("file", file)
    if os.path.splitext(name)[1].lower() not in (".mp4", ".gif"):
        raise ValueError(f"{name!r} is not a film; its name ends in .mp4 or .gif")
    fps = _arguments.number("fps", fps, 0.1, 1000)
    orbit = 0.0 if turntable is None else _arguments.number("turntable", turntable, 1e-3, 1e6)
    selected = _text_of(frames)
    if selected is None and turntable is None:
        selected = "all"
    columns, options = _named(data, columns, options)
    trajectory = _trajectory(data, selected)
    if trajectory is None:
        source = _source(data, columns, cell)
    else:
        frame_at, count = trajectory
        source = (lambda number: _source(frame_at(number), columns, cell), count)
    limits, report = _limits(threads, memory_limit, on_progress)
    film = _orrery.FilmFile(name, fps, orbit, bool(keep_frames))
    made, notes = _orrery.movie(film, source, _words({**options, "frames": selected}), *limits, report, _warn)
    return Movie(name, tuple(made), tuple(notes))


def _text_of(frames):
    """Returns the value of --frames."""
    if frames is None or isinstance(frames, str):
        return frames
    numbers = [_arguments.whole("frames", frame) for frame in frames]
    if not numbers:
        raise ValueError("frames is empty")
    return ",".join(map(str, numbers))


def _trajectory(data, selected):
    """Returns a function from the number of a frame to its data, and the number of frames; None for other data."""
    if callable(data) and not hasattr(data, "atoms"):
        if selected in (None, "all"):
            raise TypeError("a function has no number of frames; select them: frames=range(1, 49)")
        return data, 10_000_000
    if hasattr(data, "atoms") and hasattr(data, "universe"):
        steps = data.universe.trajectory

        def at(number):
            steps[number - 1]  # makes this frame the current one
            return data

        return (at, len(steps)) if len(steps) > 1 else None
    if (isinstance(data, np.ndarray) and data.ndim == 3) or (isinstance(data, (list, tuple)) and _is_of_frames(data)):
        return lambda number: data[number - 1], len(data)
    return None


def _is_of_frames(items):
    """Returns whether a sequence has frames, not positions."""
    return len(items) > 0 and (hasattr(items[0], "get_chemical_symbols") or isinstance(items[0], Mapping) or np.ndim(items[0]) == 2)
