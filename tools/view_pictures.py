#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures and the film of docs/view.md in Chromium: tools/view_pictures.py ORRERY MELT.dump PROTEIN.pdb

MELT.dump is a trajectory with the columns id, type, x, y, z and speed. Needs ffmpeg.
"""
import pathlib
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(root / "tests/browser"))
from webdriver import Browser

orrery, melt, protein = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
folder = pathlib.Path(tempfile.mkdtemp())


class Page:
    """A page of `orrery view`, and its screenshots."""

    def __init__(self, file, *words, size=(1400, 900), dark=False):
        self._program = subprocess.Popen([orrery, "view", file.name, *words], cwd=file.parent, stdout=subprocess.PIPE, text=True)
        self.browser = Browser(*size, dark=dark)
        self.shots = 0
        self.browser.open(self._program.stdout.readline().strip())
        self.settle()

    def settle(self):
        self.browser.wait("const c = document.getElementById('picture'); return c?.dataset.settled === 'true' && c.dataset.shown")

    def choose(self, id, value):
        self.browser.run("const f = document.getElementById(arguments[0]); const r = [...f.querySelectorAll('input')].find(i => i.value === arguments[1]);"
                         "if (r) r.click(); else { f.value = arguments[1]; f.dispatchEvent(new Event('input')); f.dispatchEvent(new Event('change')); }", id, value)
        self.settle()

    def click(self, selector, index=0):
        x, y = self.place(selector, index)
        self.browser.click(x, y)
        self.settle()

    def place(self, selector, index=0):
        return self.browser.wait(
            "const e = document.querySelectorAll(arguments[0])[arguments[1]]; if (!e) return null; e.scrollIntoView({ block: 'nearest' });"
            "const b = e.getBoundingClientRect(); return b.width > 0 && [Math.round(b.left + b.width / 2), Math.round(b.top + b.height / 2)]", selector, index)

    def drag(self, start, to):
        self.browser.drag(start, to)
        self.settle()

    def shoot(self, times=1):
        for _ in range(times):
            self.browser.screenshot(folder / f"film.{self.shots:03}.png")
            self.shots += 1

    def end(self):
        self.browser.close()
        self._program.terminate()


def jpeg(page, name):
    page.browser.screenshot(folder / "shot.png")
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", folder / "shot.png", "-q:v", "4", root / "docs" / name], check=True)


def pick_two(page):
    x, y = page.place("#picture")
    page.browser.click(x - 60, y + 30)
    page.browser.wait("return !document.getElementById('picked').hidden")
    yield
    for dx in range(-170, -290, -8):  # until there is a particle
        page.browser.drag((x + dx, y + 60), (x + dx, y + 60), steps=1, key="\ue008")
        try:
            page.browser.wait("return document.getElementById('measures').textContent.includes('distance')", tries=20)
            break
        except AssertionError:
            continue
    yield


def film(page):
    x, y = page.place("#picture")
    page.shoot(2)
    for step in ((-60, 10), (-60, -20), (90, 20)):
        page.drag((x, y), (x + step[0], y + step[1]))
        page.shoot()
    page.click(".class .name", 1)
    page.shoot(2)
    page.click(".class .name", 1)
    page.click(".class .icon", 3)
    page.shoot(2)
    page.click(".class .icon", 3)
    page.choose("columns", "speed")
    page.shoot(2)
    handle = page.place(".handle", 1)
    page.drag(handle, (handle[0] - 110, handle[1]))
    page.shoot(2)
    page.browser.run("document.querySelector('input[value=\"coolwarm\"]').click()")
    page.settle()
    page.shoot(2)
    page.click("label:has(> input[name=cut][value=z])")
    page.browser.wait("return document.getElementById('command').value.includes('--slice')")
    page.settle()
    page.shoot(2)
    disc = page.place("#plane")
    page.drag(disc, (disc[0], disc[1] + 70))
    page.shoot(2)
    for _ in pick_two(page):
        page.shoot(2)
    jpeg(page, "view.jpg")
    page.browser.keys("\ue00c")
    for number in range(2, 7):
        page.choose("frame", str(number))
        page.shoot()
    page.click("label:has(#for-look)")
    page.choose("style", "night")
    page.shoot(2)
    page.choose("style", "studio")
    page.click("label:has(#for-export)")
    page.shoot(3)


page = Page(melt, "--samples", "6", "--denoise", size=(1280, 800))
film(page)
page.end()
small = "fps=1.5,scale=800:-1:flags=lanczos,split[a][b];[a]palettegen=max_colors=48[p];[b][p]paletteuse=dither=none:diff_mode=rectangle"
rate = page.shots / 60  # a minute
subprocess.run(["ffmpeg", "-v", "error", "-y", "-framerate", str(rate), "-i", folder / "film.%03d.png",
                "-filter_complex", small.replace("fps=1.5", f"fps={rate}"), root / "docs/view.gif"], check=True)
page = Page(protein, "--color-by", "chain", "--quality", "good", size=(420, 800), dark=True)
jpeg(page, "view-phone.jpg")
page.end()
page = Page(root / "scenes/book/final.toml", "--samples", "32", "--denoise", size=(1400, 900), dark=True)
x, y = page.place("#picture")
page.browser.click(x - 40, y + 20)
page.browser.wait("return !document.getElementById('picked').hidden")
jpeg(page, "view-scene.jpg")
page.end()
