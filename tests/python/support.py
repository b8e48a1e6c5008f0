# SPDX-License-Identifier: Apache-2.0
"""What the tests of the Python package share."""

import os
import subprocess
import tempfile
import unittest

import numpy as np
import orrery

PROGRAM = os.environ["ORRERY_PROGRAM"]
ROOT = os.environ["ORRERY_ROOT"]


def positions(count=60, seed=1):
    """Positions in a box of 4 x 4 x 4, exact in single precision."""
    random = np.random.default_rng(seed)
    return random.integers(-512, 512, size=(count, 3)) / 256.0


def small_scene(points, **keys):
    """A scene of a few spheres, which renders quickly at SIZE."""
    scene = orrery.Scene(camera=orrery.Camera.fit(positions(), 0.3), background=orrery.Gradient())
    scene.add_points(points, **{"radius": 0.3, **keys})
    scene.set("render.samples", 4)
    return scene


SIZE = (48, 27)


def beauty(scene):
    """The image of a scene as bytes."""
    return scene.render(*SIZE, threads=2).beauty.tobytes()


def run(*arguments):
    """Runs the program. Returns its exit status and what it prints to stderr."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=300)
    return done.returncode, done.stderr


class FolderTest(unittest.TestCase):
    """A test with a separate folder as its working directory."""

    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self._old = os.getcwd()
        os.chdir(self._folder.name)

    def tearDown(self):
        os.chdir(self._old)
        self._folder.cleanup()
