# SPDX-License-Identifier: Apache-2.0
"""The interactive view: the page of a scene."""

import json
import pathlib
import unittest
import urllib.error
import urllib.request

import numpy as np
import orrery
from support import FolderTest, positions, run, small_scene


class Page:
    """A client of a view."""

    def __init__(self, view):
        self._address, _, self._secret = view.address.partition("?token=")

    def get(self, path, body=None, secret=None):
        data = None if body is None else json.dumps(body).encode()
        fields = {"Authorization": f"Bearer {self._secret if secret is None else secret}"}
        request = urllib.request.Request(self._address + path, data=data, headers=fields)
        with urllib.request.urlopen(request, timeout=600) as answer:
            return answer.read()

    def wish(self, options=None, camera=None):
        """Requests an image, waits until it is complete, and returns the state of the page."""
        number = json.loads(self.get("wish", {"options": options or {}, "camera": camera or []}))["wish"]
        while True:
            state = json.loads(self.get("state"))
            if state["served"] >= number:
                return state
            self.get(f"frame?after=1000000000&state={state['number']}")


def points_scene():
    scene = orrery.Scene(camera=orrery.Camera.fit(positions(50)), background=orrery.Constant(1))
    scene.add_points(positions(50), radius=0.2, columns={"mass": np.arange(50.0)})
    return scene


class View(FolderTest):
    def test_the_statements_of_the_page_make_its_picture(self):
        scene = points_scene()
        with scene.view(48, 36, samples=2) as view:
            page = Page(view)
            x, y, z = page.wish()["camera"]["look_from"]
            state = page.wish({
                "--width": "48", "--height": "36", "--samples": "3",
                "--set": ["background.color=[0.5, 0.6, 0.7]", "background.type=constant"]}, [f"camera.look_from=[{x + 1}, {y}, {z}]"])
            self.assertEqual(state["problem"], "")
            pathlib.Path("page.exr").write_bytes(page.get("picture.exr"))
            settings = view.settings()
        self.assertEqual(settings["background.type"], "constant")
        self.assertIn('scene.set("background.type", "constant")', state["command"])
        picture = eval_statements(state["command"], scene)
        picture.write("own.exr", reproducible=True)
        self.assertEqual(run("compare", "page.exr", "own.exr", "--fail-above", "max=0"), (0, ""))

    def test_a_picked_particle_has_its_columns(self):
        three = np.array([[0.0, 0, 0], [3, 0, 0], [-3, 0, 0]])
        scene = orrery.Scene(camera=orrery.Camera.fit(three))
        scene.add_points(three, radius=1, columns={"mass": [5.0, 6, 7]})
        with scene.view(32, 32, samples=1) as view:
            page = Page(view)
            self.assertEqual(page.wish()["problem"], "")
            picked = json.loads(page.get("pick?x=0.5&y=0.5"))
        self.assertEqual(picked["center"], [0, 0, 0])
        self.assertIn(["mass", "5"], picked["values"])

    def test_faults_are_shown_in_the_page(self):
        with small_scene(positions()).view(16, 9, samples=1) as view:
            page = Page(view)
            self.assertIn("camera.vfov", page.wish({"--set": "camera.vfov=500"})["problem"])
            self.assertIn("scene.set", page.wish({"--set": "color.config=/etc/passwd"})["problem"])
            self.assertIn("--noise", page.wish({"--noise": "x"})["problem"])
            self.assertEqual(page.wish()["problem"], "")

    def test_only_the_secret_is_served(self):
        with small_scene(positions()).view(16, 9, samples=1) as view:
            with self.assertRaises(urllib.error.HTTPError) as caught:
                Page(view).get("state", secret="wrong")
            caught.exception.close()
            self.assertEqual(caught.exception.code, 403)

    def test_a_closed_view_is_gone(self):
        view = small_scene(positions()).view(16, 9, samples=10**6)
        address = view.address
        self.assertIn(address.replace("&", "&amp;"), view._repr_html_())
        view.close()
        view.close()
        self.assertIn("closed", repr(view) + view._repr_html_())
        with self.assertRaises(urllib.error.URLError):
            urllib.request.urlopen(address)

    def test_arguments(self):
        for name, value in {"port": 70000, "samples": "x", "threads": 0, "page_height": -1}.items():
            with self.assertRaises((TypeError, ValueError), msg=name):
                small_scene(positions()).view(**{name: value})
        with small_scene(positions()).view(16, 9) as view:
            port = int(view.address.split(":")[2].split("/")[0])
            with self.assertRaises(orrery.OutputError):
                small_scene(positions()).view(port=port)


def eval_statements(text, scene):
    """Runs the statements of a page; returns the value of the last one."""
    *statements, last = text.splitlines()
    for statement in statements:
        exec(statement, {"scene": scene})
    return eval(last, {"scene": scene})


if __name__ == "__main__":
    unittest.main()
