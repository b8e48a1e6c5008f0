#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Uses `orrery view` in a browser as a user would: tests/view/browser.py ORRERY WORK_FOLDER controls|dark|tabs|scene

Exit status 77 if Chromium or its driver is not installed. Screenshots stay in WORK_FOLDER.
"""
import atexit
import html
import pathlib
import shlex
import shutil
import signal
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "browser"))
from webdriver import Browser, exit_if_missing

orrery, work = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
exit_if_missing()
shutil.rmtree(work, ignore_errors=True)
work.mkdir(parents=True)

SHIFT = "\ue008"
frames = []
for frame in range(3):
    rows = "".join(f"{i + 1} {1 + i % 2} {i % 4} {i // 4 % 4} {i // 16 + 0.2 * frame} {i * (frame + 1)}\n" for i in range(64))
    frames.append(f"ITEM: TIMESTEP\n{frame}\nITEM: NUMBER OF ATOMS\n64\nITEM: BOX BOUNDS pp pp pp\n0 4\n0 4\n0 5\n"
                  f"ITEM: ATOMS id type x y z speed\n{rows}")
(work / "melt.dump").write_text("".join(frames))


class Program:
    """A running `orrery view`."""

    def __init__(self, *words):
        self._process = subprocess.Popen([orrery, "view", *words], cwd=work, stdout=subprocess.PIPE, text=True)
        atexit.register(self._process.kill)  # of a test that fails
        self.url = self._process.stdout.readline().strip()

    def end(self, how=signal.SIGTERM):
        self._process.send_signal(how)
        return self._process.wait()


def command_of(browser):
    return browser.run("return document.getElementById('command').value")


def settle(browser, problem=""):
    """Waits until the last wish is granted, or refused with this problem."""
    browser.wait("const p = document.getElementById('problem');"
                 "return document.getElementById('picture').dataset.settled === 'true' "
                 "&& (p.hidden ? '' : p.textContent).includes(arguments[0])", problem)
    text = browser.run("const p = document.getElementById('problem'); return p.hidden ? '' : p.textContent")
    expect(bool(problem) == bool(text), text)


def choose(browser, option, value):
    browser.run("const f = document.getElementById(arguments[0]);"
                "if (f.type === 'checkbox') f.checked = arguments[1] !== ''; else f.value = arguments[1];"
                "f.dispatchEvent(new Event('change'))", option, value)


def expect(condition, text):
    if not condition:
        raise AssertionError(text)


def check_command(browser, name):
    """The command that the page shows makes the picture that it shows."""
    command = shlex.split(command_of(browser))
    expect(command[0] == "orrery", command)
    subprocess.run([orrery, *command[1:-2], "-q", "-o", f"{name}.png"], cwd=work, check=True)
    mine = download(browser, "picture.png").rename(work / f"{name}.page.png")
    status = subprocess.run([orrery, "compare", mine, f"{name}.png", "--fail-above", "max=0"], cwd=work, capture_output=True, text=True)
    expect(status.returncode == 0, f"{name}: {command_of(browser)}\n{status.stdout}{status.stderr}")


def download(browser, name):
    (work / "downloads").mkdir(exist_ok=True)
    return browser.download((work / "downloads").resolve(), name, f'[data-file="{name}"]')


def watch_for_darkness(browser):
    """From now on, window.darkest is the smallest brightness that a pixel of the picture has had."""
    browser.run("""
        window.darkest = 255;
        const look = () => {
          const canvas = document.getElementById('picture');
          const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
          for (let i = 0; i < data.length; i += 4)
            window.darkest = Math.min(window.darkest, Math.max(data[i], data[i + 1], data[i + 2]));
          requestAnimationFrame(look);
        };
        look();""")


def look(browser, program, name, options):
    browser.open(program.url)
    settle(browser)
    expect("token" not in browser.run("return location.href"), "the address does not show the secret")
    check_command(browser, f"{name}-first")
    box = position(browser)
    before = command_of(browser)
    up = browser.run("return fetch('state', { headers: { Authorization: 'Bearer ' + sessionStorage.getItem('secret') } })"
                     ".then(a => a.json())")["up"]
    browser.drag(box, (box[0] + 80, box[1] + 30))
    settle(browser)
    expect(command_of(browser) != before, "a drag moves the camera")
    up = ", ".join(f"{x:g}" for x in up)
    expect(f"camera.up=[{up}]" in command_of(browser), f"a drag keeps the horizon: {command_of(browser)}")
    browser.drag(box, (box[0] + 40, box[1]), key=SHIFT)
    browser.drag(box, (box[0] - 30, box[1] + 20), button=2)
    browser.wheel(round(box[0]), round(box[1]), -200)
    settle(browser)
    check_command(browser, f"{name}-moved")
    for option, value in options:
        choose(browser, option, value)
        settle(browser)
    check_command(browser, f"{name}-chosen")
    browser.screenshot(work / f"{name}.png.screen.png")
    command = command_of(browser)
    browser.run("location.reload()")
    settle(browser)
    expect(command_of(browser) == command, "a reload shows the same picture")


def position(browser):
    """The middle of the picture, in the window."""
    return browser.run("const b = document.getElementById('picture').getBoundingClientRect();"
                       "return [b.left + b.width / 2, b.top + b.height / 2]")


def pick(browser):
    x, y = (round(v) for v in position(browser))
    browser.click(x, y)
    browser.wait("return !document.getElementById('picked').hidden")
    text = browser.run("return document.getElementById('picked').innerText")
    for word in ("row ", "melt.dump", "centre", "radius", "speed", "type"):
        expect(word in text, f"`{word}` is missing:\n{text}")
    before = command_of(browser)
    browser.click(x + 40, y + 20, count=2)
    browser.wait("return document.getElementById('command').value !== arguments[0]", before)
    settle(browser)
    browser.click(x, y)
    center = browser.run("return document.querySelector('#picked-values dd').textContent").split(", ")
    look_at = command_of(browser).split("camera.look_at=[")[1].split("]")[0].split(", ")
    expect(all(abs(float(a) - float(b)) < 1e-4 for a, b in zip(center, look_at)), f"{center} is not {look_at}")


def play(browser):
    def frame():
        return int(browser.run("return document.getElementById('frame').value"))
    choose(browser, "frame", "1")
    settle(browser)
    camera = command_of(browser).split("--set")[1:]
    browser.run("document.getElementById('play').click()")
    for number in (2, 3, 1, 2):
        browser.wait(f"return document.getElementById('frame').value === '{number}'")
    browser.run("document.getElementById('play').click()")
    settle(browser)
    expect(command_of(browser).split("--set")[1:] == camera, "frames do not move the camera")
    expect(f"--frame {frame()} " in command_of(browser) or frame() == 1, command_of(browser))


def never_black(browser, program):
    """Neither while it is dragged nor while the next image is rendered is a pixel darker than the scene."""
    for option, value in [("style", "flat"), ("color-by", "none"), ("samples", "300"), ("size", "1280 720")]:
        choose(browser, option, value)
        settle(browser)
    watch_for_darkness(browser)
    box = position(browser)
    for dx in (60, -40):
        browser.drag(box, (box[0] + dx, box[1] + 20))
        settle(browser)
    darkest = browser.run("return window.darkest")
    expect(darkest > 60, f"a pixel had the brightness {darkest}")


def view_data(walk):
    """Walks through the page of a data file."""
    program = Program("melt.dump", "--width", "320", "--height", "240", "--noise", "0.2")
    browser = Browser()
    try:
        browser.open(program.url)
        settle(browser)
        walk(browser, program)
        errors = browser.errors()
        expect(not errors, errors)
    finally:
        browser.close()
    expect(program.end(signal.SIGINT) == 0, "INT ends the program with status 0")


def use_controls(browser, program):
    look(browser, program, "melt", [("color-by", "speed"), ("map", "magma"), ("range", "0:100"), ("style", "night"),
                                    ("material", "plastic"), ("select", "type == 1"), ("radius-scale", "1.3"),
                                    ("opacity", "0.5\ntype == 1: 0.3"), ("frame", "3")])
    choose(browser, "select", "nothing ==")
    settle(browser, problem="nothing")
    choose(browser, "select", "")
    choose(browser, "opacity", "")
    settle(browser)


def use_tabs(browser, program):
    for option, value in [("color-by", "speed"), ("frame", "3")]:
        choose(browser, option, value)
        settle(browser)
    pick(browser)
    play(browser)
    choose(browser, "size", "640 360")
    settle(browser)
    check_command(browser, "melt-larger")
    first = browser.tabs()[0]
    browser.new_tab()
    browser.open(program.url)
    settle(browser)
    sizes = browser.run("return [...document.getElementById('size').options].map(option => option.value)")
    expect(sizes[0] == "320 240" and sizes.count("640 360") == 1, f"the size of the start is not offered: {sizes}")
    command = command_of(browser)
    browser.switch(first)
    browser.wait("return document.getElementById('command').value === arguments[0]", command)
    # In the frame of a notebook, without cookies.
    frame = work / "frame.html"
    frame.write_text(f'<iframe src="{html.escape(program.url)}" width="900" height="700"></iframe>')
    browser.open(frame.resolve().as_uri())
    browser.enter_frame(0)
    settle(browser)
    expect(command_of(browser) == command, "a frame shows the same")
    download(browser, "scene.toml")
    expect(browser.run("return document.getElementById('problem').hidden"), "a frame downloads as well")


def view_scene():
    scene = pathlib.Path(__file__).resolve().parents[2] / "scenes/book/final.toml"
    program = Program(str(scene), "--width", "192", "--height", "108", "--samples", "4")
    for width, dark in ((1600, False), (400, True)):
        browser = Browser(width=width, dark=dark)
        try:
            if not dark:
                look(browser, program, "final", [("set", "render.seed=7\nbackground.type=constant")])
            browser.open(program.url)
            settle(browser)
            browser.screenshot(work / f"final-{width}.screen.png")
            expect(browser.run("return document.documentElement.scrollWidth <= innerWidth"), f"{width}: too wide")
        finally:
            browser.close()
    expect(program.end() == 0, "TERM ends the program with status 0")


{"controls": lambda: view_data(use_controls), "dark": lambda: view_data(never_black),
 "tabs": lambda: view_data(use_tabs), "scene": view_scene}[sys.argv[3]]()
