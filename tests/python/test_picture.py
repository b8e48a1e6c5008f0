# SPDX-License-Identifier: Apache-2.0
"""Rendered images as arrays, in files and in notebooks; interruption and other threads."""

import copy
import gc
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy as np
import orrery
from support import SIZE, FolderTest, positions, small_scene


class Arrays(FolderTest):
    @classmethod
    def setUpClass(cls):
        scene = small_scene(positions())
        scene.set("output.layers", ["Z", "N", "albedo", "CryptoObject"])
        cls.picture = scene.render(*SIZE)

    def test_shapes(self):
        w, h = SIZE
        p = self.picture
        self.assertEqual((p.width, p.height), SIZE)
        self.assertEqual((p.beauty.shape, p.beauty.dtype), ((h, w, 4), np.float32))
        self.assertEqual(p["Z"].shape, (h, w))
        self.assertEqual(p["N"].shape, (h, w, 3))
        self.assertEqual(p["CryptoObject00"].shape, (h, w, 4))
        self.assertIn("Z", p)
        self.assertNotIn("depth", p)
        np.testing.assert_array_equal(p["R"], p.beauty[..., 0])
        np.testing.assert_array_equal(p["N.Y"], p["N"][..., 1])
        with self.assertRaises(KeyError):
            p["Z.Z"]
        with self.assertRaisesRegex(KeyError, "no layer `depth`; the layers are Z, N"):
            p["depth"]
        with self.assertRaises(KeyError):
            p["N.W"]

    def test_an_index_is_no_layer(self):
        with self.assertRaisesRegex(TypeError, "layers have names"):
            self.picture[0]

    def test_no_copy_and_read_only(self):
        self.assertTrue(np.shares_memory(self.picture.beauty, self.picture.beauty))
        self.assertTrue(np.shares_memory(self.picture["Z"], self.picture["Z"]))
        self.assertTrue(self.picture.beauty.flags.c_contiguous)
        with self.assertRaises(ValueError):
            self.picture.beauty[0, 0, 0] = 1

    def test_arrays_outlive_the_picture(self):
        scene = small_scene(positions())
        scene.set("output.layers", ["Z"])
        picture = scene.render(*SIZE)
        beauty, depth = picture.beauty, picture["Z"][::2]
        wanted = beauty.copy(), depth.copy()
        del picture
        gc.collect()
        [np.zeros((SIZE[1], SIZE[0], 4), np.float32) for _ in range(50)]
        np.testing.assert_array_equal(beauty, wanted[0])
        np.testing.assert_array_equal(depth, wanted[1])

    def test_srgb8_has_the_values_of_a_png(self):
        self.picture.write("a.ppm")
        with open("a.ppm", "rb") as file:
            data = file.read()[-3 * SIZE[0] * SIZE[1] :]
        srgb = self.picture.to_srgb8()
        self.assertEqual((srgb.dtype, srgb.shape), (np.uint8, (SIZE[1], SIZE[0], 3)))
        self.assertEqual(srgb.tobytes(), data)
        self.assertGreater(self.picture.to_srgb8(exposure=1).mean(), srgb.mean())
        with self.assertRaisesRegex(ValueError, "not sRGB"):
            self.picture.to_srgb8(display="Gamma 2.0 Rec.709")
        with self.assertRaises(orrery.UsageError):
            self.picture.to_srgb8(view="none")

    def test_a_transparent_background_has_alpha(self):
        scene = orrery.Scene(background=orrery.Constant(1, alpha=0))
        scene.add_sphere((0, 0, -3), 1)
        picture = scene.render(9, 9, samples=4)
        self.assertEqual(picture.to_srgb8().shape, (9, 9, 4))
        self.assertEqual((picture.beauty[0, 0, 3], picture.beauty[4, 4, 3]), (0, 1))

    def test_notebooks_show_a_png(self):
        png = self.picture._repr_png_()
        self.picture.write("a.png")
        with open("a.png", "rb") as file:
            self.assertEqual(png, file.read())
        self.assertTrue(png.startswith(b"\x89PNG"))

    def test_errors_have_the_exit_status_of_the_program(self):
        with self.assertRaises(orrery.OutputError) as caught:
            self.picture.write("/missing/folder/x.exr")
        self.assertEqual(caught.exception.exit_status, 73)

    def test_bad_files(self):
        for names in (["a.gif"], ["none/a.exr"], ["a.exr", "a.exr"], ["a.exr", "./a.exr"], []):
            with self.assertRaises((orrery.UsageError, orrery.OutputError, TypeError)):
                self.picture.write(*names)
        for keys in ({"type": "double"}, {"bits": 12}, {"compression": "best"}, {"view": "none"}):
            with self.assertRaises(ValueError):
                self.picture.write("a.png", "b.exr", **keys)
        self.assertEqual(os.listdir(), [])

    def test_pickling_names_the_remedy(self):
        with self.assertRaisesRegex(TypeError, "a Picture cannot be pickled; pass arrays .* picture.beauty"):
            pickle.dumps(self.picture)
        self.assertTrue((copy.copy(self.picture).beauty == self.picture.beauty).all())

    def test_options_of_files(self):
        self.picture.write("a.exr")
        self.picture.write("b.exr", type="float", compression="zip", multipart=True)
        self.picture.write("a.png", bits=16, exposure=-1)
        self.assertGreater(os.path.getsize("b.exr"), os.path.getsize("a.exr"))


class LongRender(FolderTest):
    """A scene that renders for minutes unless it is stopped."""

    def setUp(self):
        super().setUp()
        self.scene = small_scene(positions())
        self.long = {"width": 640, "height": 360, "samples": 100000, "threads": 1}

    def test_an_exception_in_on_progress_stops_the_render(self):
        def stop(progress):
            self.assertGreaterEqual(progress.fraction, 0)
            raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            self.scene.render(**self.long, on_progress=stop)
        self.assertEqual(os.listdir(), [], "no checkpoint")

    def test_progress_ends_at_1(self):
        seen = []
        self.scene.render(*SIZE, on_progress=seen.append)
        self.assertEqual(seen[-1].fraction, 1)
        self.assertEqual(seen[-1].samples_done, seen[-1].samples_total)
        self.assertTrue(all(isinstance(p, orrery.Progress) for p in seen))

    def test_keyboard_interrupt_stops_the_render(self):
        # Progress shows that the render has begun; only then is the signal sent.
        def interrupt(progress):
            if progress.samples_done > 0:
                os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            self.scene.render(**self.long, on_progress=interrupt)

    def test_keyboard_interrupt_of_another_process(self):
        program = (
            "import orrery\n"
            "scene = orrery.Scene()\n"
            "scene.add_sphere((0, 0, -2), 1)\n"
            "try:\n"
            "    print('begin', flush=True)\n"
            "    scene.render(640, 360, samples=100000, threads=1)\n"
            "except KeyboardInterrupt:\n"
            "    print('interrupted')\n"
        )
        child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
        self.assertEqual(child.stdout.readline(), "begin\n")
        child.send_signal(signal.SIGINT)
        out, _ = child.communicate(timeout=100)
        self.assertEqual((out, child.returncode), ("interrupted\n", 0))

    def test_other_threads_run_meanwhile(self):
        # The render waits for another Python thread, which therefore runs while it renders.
        began, counted = threading.Event(), threading.Event()

        def count():
            began.wait()
            sum(range(1000))
            counted.set()

        class Done(Exception):
            pass

        def progress(_):
            began.set()
            if counted.is_set():
                raise Done

        thread = threading.Thread(target=count)
        thread.start()
        with self.assertRaises(Done):
            self.scene.render(**self.long, on_progress=progress)
        thread.join()

    def test_a_daemon_thread_renders_when_the_interpreter_ends(self):
        script = (
            "import threading, numpy as np, orrery\n"
            "scene = orrery.Scene(camera=orrery.Camera.fit(np.zeros((1, 3))), background=orrery.Constant(1))\n"
            "scene.add_points(np.zeros((1, 3)), radius=0.5)\n"
            "begun = threading.Event()\n"
            "render = lambda: scene.render(64, 36, samples=10**8, on_progress=lambda p: begun.set())\n"
            "threading.Thread(target=render, daemon=True).start()\n"
            "assert begun.wait(60)\n"
        )
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_progress_comes_at_most_ten_times_a_second(self):
        calls = []
        begin = time.monotonic()
        small_scene(positions()).render(64, 36, noise=0.004, threads=1, on_progress=calls.append)
        # One call each 100 ms, and one at the end.
        self.assertLessEqual(len(calls), 10 * (time.monotonic() - begin) + 2)

    def test_renders_in_several_threads(self):
        wanted = self.scene.render(*SIZE).beauty.tobytes()
        results = []
        threads = [
            threading.Thread(target=lambda: results.append(self.scene.render(*SIZE, threads=2).beauty.tobytes()))
            for _ in range(3)
        ]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(results, [wanted] * 3)

    def test_the_number_of_threads_changes_no_bit(self):
        self.assertEqual(
            self.scene.render(*SIZE, threads=1).beauty.tobytes(), self.scene.render(*SIZE, threads=2).beauty.tobytes()
        )

    def test_a_missed_target_is_a_warning(self):
        with self.assertWarnsRegex(orrery.SceneWarning, "noise"):
            self.scene.render(*SIZE, noise=1e-5, samples=16)


if __name__ == "__main__":
    unittest.main()
