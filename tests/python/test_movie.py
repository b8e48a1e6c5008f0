# SPDX-License-Identifier: Apache-2.0
"""movie(): the frames of the program, from files, trajectories and functions."""

import os
import shutil
import unittest

import numpy as np
import orrery
from support import FolderTest, positions, run

SMALL = {"width": 48, "height": 27, "samples": 2, "threads": 2}
OPTIONS = ("--width", 48, "--height", 27, "--samples", 2)
FRAMES = np.stack([positions() + [0, 0, step] for step in range(3)])
SPEED = np.arange(60.0)


def bytes_of(file):
    with open(file, "rb") as data:
        return data.read()


def movie(data, file="a.mp4", **options):
    return orrery.movie(data, file, **{**SMALL, "keep_frames": True, **options})


def frames_of(file):
    """The frames that were kept, in order."""
    folder = file + ".frames"
    return [bytes_of(os.path.join(folder, name)) for name in sorted(os.listdir(folder))]


class Frame:
    """What plot() uses of an MDAnalysis.AtomGroup, whose positions are those of the trajectory's current frame."""

    def __init__(self):
        self.atoms = self.universe = self
        self.trajectory = self
        self.ts = type("Timestep", (), {"dimensions": None})()
        self.positions = FRAMES[0]

    def __len__(self):
        return len(FRAMES) if self.trajectory is self else 60

    def __getitem__(self, frame):
        self.positions = FRAMES[frame]


class MovieTest(FolderTest):
    """ffmpeg is replaced by a program that copies its input, so that the film is its frames one after another."""

    def setUp(self):
        super().setUp()
        with open("a.xyz", "w") as file:
            for points in FRAMES:
                file.write("60\nProperties=species:S:1:pos:R:3\n")
                file.writelines(f"C {x!r} {y!r} {z!r}\n" for x, y, z in points.tolist())
        os.mkdir("bin")
        self.install("cat > \"${last#file:}\"")
        self._path = os.environ["PATH"]
        os.environ["PATH"] = os.path.abspath("bin") + ":" + self._path

    def tearDown(self):
        os.environ["PATH"] = self._path
        super().tearDown()

    def install(self, action):
        with open("bin/ffmpeg", "w") as file:
            file.write(f"#!/bin/sh\nfor last; do :; done\n{action}\n")
        os.chmod("bin/ffmpeg", 0o755)


class Movie(MovieTest):
    def test_a_file_has_the_frames_of_the_program(self):
        made = movie("a.xyz", frames="1-3", bonds=True, title="frame {frame}")
        status, error = run(
            "plot", "a.xyz", "-o", "b.mp4", "-q", "--keep-frames", "--frames", "all", *OPTIONS, "--bonds", "auto",
            "--title", "frame {frame}",
        )  # fmt: skip
        self.assertEqual(status, 0, error)
        self.assertEqual(frames_of("a.mp4"), frames_of("b.mp4"))
        self.assertEqual(bytes_of("a.mp4"), b"".join(frames_of("a.mp4")))
        self.assertEqual((made.file, made.frames), ("a.mp4", (1, 2, 3)))
        self.assertIn("fitted to the spheres of all frames", " ".join(made.notes))
        self.assertEqual(movie("a.xyz", "c.gif", keep_frames=False).frames, (1, 2, 3))
        self.assertFalse(os.path.exists("c.gif.frames"))

    def test_trajectories_have_the_same_frames(self):
        movie(FRAMES, radius=0.3, color_by=SPEED)
        wanted = frames_of("a.mp4")
        self.assertEqual(len(set(wanted)), 3)
        tables = [{**dict(zip("xyz", points.T)), "color_by": SPEED} for points in FRAMES]
        for name, data, options in (
            ("list", list(FRAMES), {"color_by": SPEED}),
            ("tables", tables, {"color_by": "color_by"}),
            ("function", lambda frame: FRAMES[frame - 1], {"color_by": SPEED, "frames": range(1, 4)}),
            ("universe", Frame(), {"columns": {"color_by": SPEED}, "color_by": "color_by"}),
        ):
            with self.subTest(name):
                movie(data, "b.mp4", radius=0.3, **options)
                self.assertEqual(frames_of("b.mp4"), wanted)
                shutil.rmtree("b.mp4.frames")

    def test_a_turntable_of_one_frame(self):
        made = movie(FRAMES[0], turntable=0.5, fps=8, radius=0.3)
        self.assertEqual(made.frames, (1, 2, 3, 4))
        self.assertEqual(len(set(frames_of("a.mp4"))), 4)

    def test_a_video_of_one_pixel_is_refused_before_it_is_rendered(self):
        for size in ({"width": 1}, {"height": 1}):
            with self.assertRaisesRegex(orrery.UsageError, "a.mp4: a video is at least 2 pixels wide and high"):
                movie(FRAMES, radius=0.3, **size)
            self.assertFalse(os.path.exists("a.mp4.frames"))
        movie(FRAMES, "a.gif", radius=0.3, width=1, height=1)

    def test_a_call_that_failed_is_continued(self):
        self.install("exit 3")
        with self.assertRaisesRegex(orrery.OutputError, "ffmpeg failed with status 3.*frames are in a.mp4.frames"):
            movie("a.xyz", keep_frames=False)
        times = [os.stat(entry).st_mtime_ns for entry in os.scandir("a.mp4.frames")]
        self.install("cat > \"${last#file:}\"")
        movie("a.xyz")
        self.assertEqual([os.stat(entry).st_mtime_ns for entry in os.scandir("a.mp4.frames")], times)

    def test_frames_of_other_data_are_rendered_again(self):
        movie(FRAMES, radius=0.3)
        old = frames_of("a.mp4")
        movie(FRAMES * 2, radius=0.3)
        self.assertTrue(all(a != b for a, b in zip(old, frames_of("a.mp4"))))

    def test_a_notebook_shows_it(self):
        self.assertIn('src="data:video/mp4;base64,', movie("a.xyz")._repr_html_())
        self.assertIn('src="data:image/gif;base64,', movie("a.xyz", "a.gif")._repr_html_())

    def test_progress_is_that_of_the_film(self):
        seen = []
        movie("a.xyz", samples=1 << 10, on_progress=lambda progress: seen.append(progress.fraction))
        self.assertEqual(seen, sorted(seen))
        self.assertLessEqual(seen[-1], 1)

    def test_errors_say_what_is_wrong(self):
        def fails(frame):
            raise KeyError("no such frame")

        for error, text, data, options in (
            (ValueError, "not a film", "a.xyz", {"file": "a.png"}),
            (TypeError, "frames=range", lambda frame: FRAMES[0], {}),
            (KeyError, "no such frame", fails, {"frames": [1, 2]}),
            (ValueError, "must have the shape", lambda frame: FRAMES[0][:, :2], {"frames": [1]}),
            (ValueError, "empty", "a.xyz", {"frames": []}),
            (ValueError, "fps", "a.xyz", {"fps": 0}),
            (orrery.SceneError, "there is no frame 4", "a.xyz", {"frames": [1, 4]}),
            (orrery.MissingInputError, "nothing.xyz", "nothing.xyz", {}),
            (orrery.UsageError, "unknown option --colour", "a.xyz", {"colour": 1}),
        ):
            with self.subTest(text), self.assertRaisesRegex(error, text):
                movie(data, **options)
        os.environ["PATH"] = "/nowhere"
        with self.assertRaisesRegex(orrery.OutputError, "install the package ffmpeg"):
            movie("a.xyz")
        with self.assertRaisesRegex(TypeError, "movie"):
            orrery.plot("a.xyz", frames="all")

    def test_an_exception_in_on_progress_stops_the_film(self):
        def stop(progress):
            raise KeyError("enough")

        with self.assertRaisesRegex(KeyError, "enough"):
            movie("a.xyz", samples=1 << 20, on_progress=stop)
        self.assertFalse(os.path.exists("a.mp4"))


if __name__ == "__main__":
    unittest.main()
