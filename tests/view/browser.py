#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Uses `orrery view` in a browser as a user would: tests/view/browser.py ORRERY WORK_FOLDER WALK...

WALK is a key of WALKS, below; all walks use one browser. Exit status 77 if Chromium or its driver is not installed.
Screenshots stay in WORK_FOLDER. Nothing here depends on time: each step waits until the page shows what it is about.
"""
import atexit
import contextlib
import html
import pathlib
import random
import shlex
import shutil
import signal
import subprocess
import sys
import time
import traceback

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "browser"))
from webdriver import Browser, exit_if_missing

orrery, work = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
exit_if_missing()
shutil.rmtree(work, ignore_errors=True)
work.mkdir(parents=True)

SHIFT, CONTROL, ESCAPE, TAB = "\ue008", "\ue009", "\ue00c", "\ue004"
SMALL = ["--width", "320", "--height", "240"]
FAST = [*SMALL, "--samples", "2"]
HOSTILE = "<img src=x onerror=alert(1)>"
FINAL = pathlib.Path(__file__).resolve().parents[2] / "scenes/book/final.toml"
frames = []
for frame in range(3):
    rows = "".join(f"{i + 1} {1 + i % 2} {i % 4} {i // 4 % 4} {i // 16 + 0.2 * frame} {i * (frame + 1)}\n" for i in range(64))
    frames.append(f"ITEM: TIMESTEP\n{1000 * frame}\nITEM: NUMBER OF ATOMS\n64\nITEM: BOX BOUNDS pp pp pp\n0 4\n0 4\n0 5\n"
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


def expect(condition, text):
    if not condition:
        raise AssertionError(text)


def command_of(browser):
    return browser.run("return document.getElementById('command').value")


def settle(browser, problem=""):
    """Waits until the last wish is granted, or refused with this problem, and its command is shown."""
    browser.wait("const c = document.getElementById('picture');"
                 "return c && c.dataset.settled === 'true' && c.dataset.shown && (c.dataset.problem || '').includes(arguments[0])", problem)
    text = browser.run("return document.getElementById('picture').dataset.problem || ''")
    expect(bool(problem) == bool(text), text)


def wait_for_command(browser, part, is_part=True):
    browser.wait("return document.getElementById('command').value.includes(arguments[0]) === arguments[1]", part, is_part)
    settle(browser)


def choose(browser, option, value):
    """Sets a field by its id, once the page has it."""
    browser.wait("return document.getElementById(arguments[0])", option)
    browser.run("const f = document.getElementById(arguments[0]), v = arguments[1];"
                "const radio = [...f.querySelectorAll('input')].find(one => one.value === v);"
                "if (radio) { radio.click(); return; }"
                "if (f.type === 'checkbox') f.checked = v !== ''; else f.value = v;"
                "f.dispatchEvent(new Event('change'))", option, value)


def place_of(browser, selector, index=0):
    """The middle of an element, once it can be seen, after its tab and its fold were opened."""
    browser.wait("return document.querySelectorAll(arguments[0])[arguments[1]]", selector, index)
    return browser.wait(
        "const e = document.querySelectorAll(arguments[0])[arguments[1]]; if (!e) return null;"
        "e.scrollIntoView({ block: 'nearest' }); const b = e.getBoundingClientRect();"
        "return b.width > 0 && [Math.round(b.left + b.width / 2), Math.round(b.top + b.height / 2)]", selector, index)


class Hand:
    """Clicks with the mouse, and counts."""

    def __init__(self, browser):
        self.browser, self.clicks = browser, 0

    def click(self, selector, index=0):
        self.at(*place_of(self.browser, selector, index))

    def at(self, x, y, key=None):
        self.clicks += 1
        if not key:
            return self.browser.click(x, y)
        self.browser.drag((x, y), (x, y), steps=1, key=key)

    def drag(self, selector, dx, dy, index=0):
        self.clicks += 1
        x, y = place_of(self.browser, selector, index)
        self.browser.drag((x, y), (x + dx, y + dy))


def compare(browser, name, command):
    subprocess.run([orrery, *shlex.split(command)[1:-2], "-q", "-o", f"{name}.png"], cwd=work, check=True)
    mine = download(browser, "picture.png").rename(work / f"{name}.page.png")
    status = subprocess.run([orrery, "compare", mine, f"{name}.png", "--fail-above", "max=0"], cwd=work, capture_output=True, text=True)
    expect(status.returncode == 0, f"{name}: {command}\n{status.stdout}{status.stderr}")


def check_command(browser, name):
    """The command that the page shows makes the picture that it shows."""
    settle(browser)
    command = command_of(browser)
    expect(shlex.split(command)[0] == "orrery", command)
    compare(browser, name, command)


def download(browser, name):
    (work / "downloads").mkdir(exist_ok=True)
    return browser.download((work / "downloads").resolve(), name, f'[data-file="{name}"]')


def errors_of(browser):
    """Errors of the console, except answers that make the page ask again."""
    return [error for error in browser.errors() if "409 (Conflict)" not in error]


def watch_for_darkness(browser):
    """From now on, window.darkest is the smallest brightness that a pixel of the picture has had."""
    browser.run("""
        window.darkest = 255;
        const look = () => {
          const canvas = document.getElementById('picture');
          const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
          for (let i = 0; i < data.length; i += 4)
            if (data[i + 3] === 255) window.darkest = Math.min(window.darkest, Math.max(data[i], data[i + 1], data[i + 2]));
          requestAnimationFrame(look);
        };
        look();""")


def position(browser):
    """The middle of the picture, in the window."""
    return place_of(browser, "#picture")


def particles(browser):
    """Two places in the window, far from each other and left of the middle, where the picture has a colour."""
    return browser.run("""
        const canvas = document.getElementById('picture'), box = canvas.getBoundingClientRect(), found = [];
        const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
        const has = (x, y) => { const i = 4 * (y * canvas.width + x), c = [data[i], data[i + 1], data[i + 2]];
                                return Math.max(...c) - Math.min(...c) > 60; };
        for (let y = 20; y < canvas.height - 5; ++y)
          for (let x = Math.floor(canvas.width / 2); x > 5; --x)
            if ([[0, 0], [4, 0], [-4, 0], [0, 4], [0, -4]].every(([dx, dy]) => has(x + dx, y + dy))
                && found.every(([u, v]) => Math.hypot(x - u, y - v) > canvas.height / 4)) found.push([x, y]);
        return found.slice(0, 2).map(([x, y]) => [Math.round(box.left + x * box.width / canvas.width),
                                                  Math.round(box.top + y * box.height / canvas.height)]);""")


def is_empty(browser, selector):
    return browser.run("const e = document.querySelector(arguments[0]); return !e || e.hidden || e.textContent === ''", selector)


def look(browser, name, options):
    expect("token" not in browser.run("return location.href"), "the address does not show the secret")
    check_command(browser, f"{name}-first")
    x, y = position(browser)
    before = command_of(browser)
    up = browser.run("return fetch('state', { headers: { Authorization: 'Bearer ' + sessionStorage.getItem('secret') } })"
                     ".then(a => a.json())")["up"]
    browser.drag((x, y), (x + 80, y + 30))
    browser.wait("return document.getElementById('command').value !== arguments[0]", before)
    settle(browser)
    up = ", ".join(f"{x:g}" for x in up)
    expect(f"camera.up=[{up}]" in command_of(browser), f"a drag keeps the horizon: {command_of(browser)}")
    browser.drag((x, y), (x + 40, y), key=SHIFT)
    browser.drag((x, y), (x - 30, y + 20), button=2)
    browser.wheel(x, y, -200)
    settle(browser)
    check_command(browser, f"{name}-moved")
    for option, value in options:
        choose(browser, option, value)
        settle(browser)
    check_command(browser, f"{name}-chosen")
    browser.screenshot(work / f"{name}.screen.png")
    command = command_of(browser)
    browser.reload()
    wait_for_command(browser, command)


@contextlib.contextmanager
def shown(browser, *words, size=(1400, 900)):
    """A program, and its page in an empty window of this size."""
    program = Program(*words)
    browser.renew(*size)
    browser.open(program.url)
    settle(browser)
    yield program
    errors = errors_of(browser)
    expect(not errors, errors)
    expect(program.end(signal.SIGINT) == 0, "INT ends the program with status 0")


def use_controls(browser):
    with shown(browser, "melt.dump", *FAST):
        click_controls(browser)


def click_controls(browser):
    look(browser, "melt", [("columns", "speed"), ("range", "0:100"), ("style", "night"),
                           ("material", "plastic"), ("select", "type == 1"), ("radius-scale", "1.3"),
                           ("opacity", "0.5"), ("outline", "2"), ("ground", "on"), ("frame", "3")])
    browser.run("document.querySelector('input[name=\"--map\"][value=\"magma\"]').click()")
    wait_for_command(browser, "--map magma")
    check_command(browser, "melt-map")
    for option, value in [("samples", ""), ("style", "flat"), ("noise", "0.3")]:
        choose(browser, option, value)
    wait_for_command(browser, "--noise 0.3")
    check_command(browser, "melt-noise")
    choose(browser, "select", "nothing ==")
    settle(browser, problem="nothing")
    message = browser.run("return [...document.querySelectorAll('.message')].filter(m => !m.hidden).map(m => m.textContent).join()")
    expect("nothing" in message, f"the message is under the field: {message}")
    browser.run("document.getElementById('undo').click()")
    settle(browser)
    expect("nothing" not in command_of(browser), "undo takes back what was wrong")


def keep_legend(browser):
    """The classes of the legend are those of its title, also while another column is read and its range is faulty."""
    with shown(browser, "melt.dump", *FAST, "--color-by", "type"):
        expect(browser.run("return document.getElementById('range-all').disabled"), "there is no range to leave")
        browser.wait("return document.querySelectorAll('.class').length === 2")
        browser.run("""
            window.legends = new Set();
            const legend = document.getElementById('legend');
            new MutationObserver(() => window.legends.add(`${legend.querySelector('h2').textContent} ${legend.querySelectorAll('.class').length}`))
              .observe(legend, { childList: true });
            for (const [id, value] of [['columns', 'id'], ['range', '1:']]) {
              document.getElementById(id).value = value;
              document.getElementById(id).dispatchEvent(new Event('change'));
            }""")
        settle(browser, problem="range")
        browser.run("document.getElementById('range-all').click()")
        wait_for_command(browser, "--color-by id")
        browser.wait("return document.querySelector('#legend h2').textContent === 'id'")
        wrong = [one for one in browser.run("return [...window.legends]") if one.startswith("type") and one != "type 2"]
        expect(not wrong, f"the legend has shown {wrong}")


def walk_at_random(browser):
    """A random walk through the controls: the picture is that of the command, and undo goes all the way back."""
    with shown(browser, "melt.dump", *FAST):
        walk_and_undo(browser, random.Random(1))


def walk_and_undo(browser, chance):
    first = command_of(browser)
    steps = [("columns", ["speed", "none", ""]), ("style", ["flat", "night", "studio"]), ("material", ["metal", "matte"]),
             ("select", ["type == 1", "z > 0\nx < 3", ""]), ("slice", ["z=2", ""]), ("representation", ["ball-and-stick", "spheres"]),
             ("outline", ["1.5", "0"]), ("opacity", ["0.4", "1"]), ("title", ["t = {step}", ""]), ("box", ["on", ""]),
             ("perspective", ["30", "0"]), ("background", ["navy", ""]), ("color-bar", ["on", ""]), ("frame", ["2", "1"])]
    changes = 0
    for i in range(14):
        option, values = chance.choice(steps)
        before = command_of(browser)
        choose(browser, option, chance.choice(values))
        browser.wait("return document.getElementById('picture').dataset.settled === 'true'")
        if browser.run("return document.getElementById('picture').dataset.problem"):  # options that do not go together
            browser.run("document.getElementById('undo').click()")
            settle(browser)
        changes += command_of(browser) != before
        if i % 4 == 3:
            check_command(browser, f"walk-{i}")
    expect(changes > 5, changes)
    for _ in range(100):
        if browser.run("return document.getElementById('undo').disabled"):
            break
        browser.keys_with(CONTROL, "z")
        settle(browser)
    expect(command_of(browser) == first, f"{command_of(browser)} is not {first}")
    browser.run("document.getElementById('redo').click()")
    browser.wait("return document.getElementById('command').value !== arguments[0]", first)
    settle(browser)
    browser.run("history.back()")
    settle(browser)


def do_tasks(browser):
    """The five tasks of a new user, with the mouse and without typing, and how many clicks they take."""
    (work / "films").mkdir()
    if shutil.which("ffmpeg"):
        with shown(browser, "melt.dump", *FAST, "--save-to", "films"):
            click_tasks(browser, Hand(browser))
            use_films(browser, Hand(browser))


def click_tasks(browser, hand):

    def task(name, most, *parts):
        for part in parts:
            wait_for_command(browser, part)
        expect(hand.clicks <= most, f"{name}: {hand.clicks} clicks")
        check_command(browser, name)
        browser.screenshot(work / f"{name}.screen.png")
        hand.clicks = 0

    # A list of the browser's own opens outside the page, so its choice is made by the keyboard; it counts as two clicks.
    choose(browser, "columns", "speed")
    hand.clicks += 2
    settle(browser)
    browser.wait("const h = document.getElementById('histogram'); return h && !h.hidden")
    hand.drag(".handle", -80, 0, index=1)
    task("colour", 3, "--color-by speed", "--range 0:")
    choose(browser, "columns", "type")
    settle(browser)
    browser.wait("return document.querySelectorAll('.class').length === 2")
    hand.click(".class .name", 1)
    task("hide", 2, "--select 'type != 2'")
    hand.click(".class .name", 1)
    wait_for_command(browser, "--select", False)
    hand.clicks = 0
    hand.click("label:has(> input[name=cut][value=z])")
    task("cut", 2, "--slice z=")
    hand.drag("#plane", 0, 40)
    before = command_of(browser)
    hand.click("label:has(> input[name=cut][value=off])")
    wait_for_command(browser, "--slice", False)
    expect("--slice z=1.5 " not in before, f"the plane is dragged: {before}")
    hand.clicks = 0
    first, second = particles(browser)
    hand.at(*first)
    browser.wait("return !document.getElementById('picked').hidden")
    hand.at(*second, key=SHIFT)
    browser.wait("return document.getElementById('measures').textContent.includes('distance')")
    distance = browser.run("return document.querySelector('#measures dd').textContent")
    expect(float(distance.split(",")[0]) > 0, distance)
    task("distance", 3)
    browser.keys(ESCAPE)
    browser.wait("return document.getElementById('picked').hidden")
    hand.click("#film-bar")
    hand.click("#film")
    browser.wait("return [...document.querySelectorAll('.toast')].some(t => t.textContent.includes('film'))")
    expect(hand.clicks <= 3, hand.clicks)
    browser.wait("return [...document.querySelectorAll('.toast')].some(t => t.textContent.includes('Film saved'))")
    expect((work / "films/film.mp4").stat().st_size > 0, "the film is in the folder of --save-to")
    (work / "films/film.mp4").unlink()


def use_films(browser, hand):
    """A film that is cancelled leaves no film, and the next one does not replace it."""
    choose(browser, "samples", "20000")
    browser.wait("return document.getElementById('command').value.includes('--samples 20000')")
    hand.click("#film")
    browser.wait("return !document.getElementById('film-cancel').hidden")
    browser.run("document.getElementById('film-cancel').click()")  # it moves while the words beside it change
    browser.wait("return [...document.querySelectorAll('.toast')].some(t => t.textContent.includes('stopped'))")
    expect(not (work / "films/film.mp4").exists(), "no film is left")
    choose(browser, "samples", "1")
    settle(browser)
    (work / "films/film.mp4").write_text("mine")
    hand.click("#film")
    browser.wait("return [...document.querySelectorAll('.toast')].some(t => t.textContent.includes('film-2.mp4'))")
    expect((work / "films/film.mp4").read_text() == "mine", "nothing is replaced")


def pick(browser):
    x, y = position(browser)
    browser.click(x, y)
    browser.wait("return !document.getElementById('picked').hidden")
    text = browser.run("return document.getElementById('picked').innerText")
    for word in ("row ", "melt.dump", "centre", "radius", "speed", "type"):
        expect(word in text, f"`{word}` is missing:\n{text}")
    expect(browser.run("return document.querySelectorAll('#marks circle').length") == 2, "the particle has a mark")
    before = command_of(browser)
    browser.keys(ESCAPE)
    browser.click(x + 40, y + 20, count=2)
    browser.wait("return document.getElementById('command').value !== arguments[0]", before)
    settle(browser)
    browser.keys(ESCAPE)
    browser.wait("return document.getElementById('picked').hidden")
    browser.click(x, y)
    browser.wait("return !document.getElementById('picked').hidden")
    center = browser.run("return document.querySelector('#picked-values dd').textContent").split(", ")
    look_at = command_of(browser).split("camera.look_at=[")[1].split("]")[0].split(", ")
    expect(all(abs(float(a) - float(b)) < 1e-3 for a, b in zip(center, look_at)), f"{center} is not {look_at}")
    browser.run("[...document.querySelectorAll('#picked-actions button')].find(b => b.textContent === 'Hide').click()")
    wait_for_command(browser, "!(id ==")
    check_command(browser, "hidden")
    browser.run("document.getElementById('undo').click()")
    wait_for_command(browser, "!(id ==", False)


def play(browser):
    choose(browser, "frame", "1")
    settle(browser)
    camera = command_of(browser).split("--set")[1:]
    browser.run("document.getElementById('speed').value = '50'; document.getElementById('play').click()")
    for number in (2, 3, 1, 2):
        browser.wait(f"return document.getElementById('frame').value === '{number}'", pause=0.001)
    browser.wait("return document.getElementById('ahead').style.width === '100%'")  # all frames are kept
    browser.run("document.getElementById('play').click()")
    settle(browser)
    expect(command_of(browser).split("--set")[1:] == camera, "frames do not move the camera")
    number = browser.run("return document.getElementById('frame').value")
    expect(f"--frame {number} " in command_of(browser) or number == "1", command_of(browser))
    choose(browser, "frame", "3")
    wait_for_command(browser, "--frame 3")
    browser.wait("return document.getElementById('frame-number').value.includes('step 2,000')")


def never_black(browser):
    """Neither while it is dragged nor while the next image is rendered is a pixel darker than the scene."""
    with shown(browser, "melt.dump", *FAST):
        drag_and_watch(browser)


def drag_and_watch(browser):
    for option, value in [("style", "flat"), ("columns", "none"), ("samples", "64"), ("size", "960 540")]:
        choose(browser, option, value)
        settle(browser)
    watch_for_darkness(browser)
    x, y = position(browser)
    for dx in (60, -40):
        browser.drag((x, y), (x + dx, y + 20))
        settle(browser)
    darkest = browser.run("return window.darkest")
    expect(darkest > 60, f"a pixel had the brightness {darkest}")


def use_tabs(browser):
    with shown(browser, "melt.dump", *FAST) as program:
        walk_through_tabs(browser, program)


def walk_through_tabs(browser, program):
    for option, value in [("columns", "speed"), ("frame", "3")]:
        choose(browser, option, value)
        settle(browser)
    pick(browser)
    play(browser)
    choose(browser, "size", "640 360")
    wait_for_command(browser, "--width 640")
    check_command(browser, "melt-larger")
    command, first = command_of(browser), browser.tabs()[0]
    browser.new_tab()
    browser.open(program.url)
    settle(browser)
    expect("--width 320" in command_of(browser), f"another tab begins as the command line says: {command_of(browser)}")
    choose(browser, "style", "flat")
    wait_for_command(browser, "--style flat")
    check_command(browser, "second-tab")
    browser.switch(first)
    expect(command_of(browser) == command, "each tab has a view of its own")
    check_command(browser, "first-tab")  # asks for its image again
    # In the frame of a notebook, without cookies.
    frame = work / "frame.html"
    frame.write_text(f'<iframe src="{html.escape(program.url)}" width="900" height="700"></iframe>')
    browser.open(frame.resolve().as_uri())
    browser.enter_frame(0)
    settle(browser)
    choose(browser, "style", "night")
    wait_for_command(browser, "--style night")
    browser.run("document.getElementById('undo').click()")
    wait_for_command(browser, "--style night", False)
    download(browser, "scene.toml")
    expect(is_empty(browser, "#errors"), "a frame downloads as well")


def fill_window(browser):
    """The picture has the pixels of its place, also when the window changes; and what the page says after the end of the program."""
    program = Program("melt.dump", "--samples", "2")
    browser.renew(1000, 700)
    browser.open(program.url)
    settle(browser)
    size = browser.run("const b = document.getElementById('stage').getBoundingClientRect(); return [b.width, b.height]")
    expect(f"--width {round(size[0])}" in command_of(browser) and f"--height {round(size[1])}" in command_of(browser), command_of(browser))
    check_command(browser, "window")
    browser.resize(420, 800)
    wait_for_command(browser, "--width 420")
    expect(browser.run("return document.documentElement.scrollWidth <= innerWidth"), "too wide for a phone")
    browser.resize(420, 800, pixels=2)
    browser.reload()
    wait_for_command(browser, "--width 840")
    check_command(browser, "dense")
    program.end()
    browser.wait("return document.getElementById('errors').textContent.includes('has ended')")
    expect("Copy command" in browser.run("return document.getElementById('errors').textContent"), "the command is offered")


AUDIT = (pathlib.Path(__file__).resolve().parent / "audit.js").read_text()


def audit(browser):
    """People who use a keyboard or a screen reader, or who see little, reach all: light and dark, wide and narrow."""
    with shown(browser, "melt.dump", *FAST, "--color-by", "type"):
        audit_states(browser, "data")
        audit_keyboard(browser)
        browser.dark(True)
        browser.resize(420, 800)
        browser.reload()
        settle(browser)
        audit_states(browser, "dark and narrow")
    with shown(browser, str(FINAL), *FAST):
        browser.wait("return document.querySelectorAll('.object').length > 100")
        audit_states(browser, "scene")


def audit_states(browser, name):
    """Looks at each tab with all its folds open, at what is picked, at the range of a column, an error, and the list of keys."""
    def check(state):
        findings = browser.run(AUDIT)
        expect(not findings, f"{name}, {state}:\n" + "\n".join(findings))

    browser.run("for (const d of document.querySelectorAll('details:not(.object ~ .object)')) d.open = true;")
    for tab in ("export", "annotate", "camera", "look", "data"):
        browser.run("document.getElementById('for-' + arguments[0]).click()", tab)
        check(tab)
    browser.click(*(particles(browser) or [position(browser)])[0])
    browser.wait("return !document.getElementById('picked').hidden")
    check("picked")
    browser.keys("?")
    browser.wait("return document.getElementById('keys').open")
    check("keys")
    browser.keys(ESCAPE)
    browser.wait("return !document.getElementById('keys').open")
    browser.keys(ESCAPE)
    if name == "scene":
        return
    choose(browser, "columns", "speed")
    choose(browser, "range", "1:")
    settle(browser, problem="range")
    check("histogram and message")
    choose(browser, "columns", "")
    settle(browser)


def audit_keyboard(browser):
    """The key Tab visits all that can be used, in the order of the page, and shows where it is."""
    visible = browser.run("""
        const radios = new Set();
        window.stops = [...document.querySelectorAll('button, input, select, textarea, summary, [tabindex="0"]')]
          .filter(e => !e.disabled && e.checkVisibility() && !(e.type === 'radio' && !e.checked));
        window.stops[0].focus();
        return window.stops.length""")
    order = []
    for _ in range(visible - 1):
        browser.keys(TAB)
        order.append(browser.run("""
            const e = document.activeElement, styles = [e, e.closest('label') ?? e].map(one => getComputedStyle(one));
            return [window.stops.indexOf(e), styles.some(style => style.outlineStyle !== 'none')]"""))
    expect([i for i, _ in order] == list(range(1, visible)), f"Tab visits {order} of {visible}")
    expect(all(is_marked for _, is_marked in order), f"the focus cannot be seen: {order}")
    browser.run("document.activeElement.blur()")
    browser.keys("5")
    browser.wait("return document.getElementById('tab-export').checkVisibility()")
    browser.keys("1]")
    wait_for_command(browser, "--frame 2")
    browser.keys("[")
    wait_for_command(browser, "--frame 2", False)
    browser.keys("x")
    wait_for_command(browser, "camera.look_from")


def view_hostile(browser):
    """Names of files, columns and classes are text, whatever is in them."""
    name = f"{HOSTILE}'\"`&.csv".replace("/", "")
    rows = "".join(f"{i},0,0,\"{HOSTILE}{i % 3}\",{'nan' if i == 2 else i}\n" for i in range(9))
    (work / name).write_text(f"x,y,z,\"{HOSTILE}\",value\n{rows}")
    with shown(browser, name, *FAST, "--radius", "0.4", "--color-by", HOSTILE):
        browser.wait("return document.querySelectorAll('.class').length === 3")
        x, y = position(browser)
        browser.click(x, y)
        browser.wait("return !document.getElementById('picked').hidden")
        expect(browser.run("return document.querySelectorAll('img').length") == 0, "a name has become HTML")
        browser.run("document.querySelector('.class .name').click()")
        wait_for_command(browser, "--select")
        check_command(browser, "hostile")
        choose(browser, "columns", "value")
        settle(browser)
        browser.wait("const h = document.getElementById('histogram'); return h && !h.hidden")


def view_damaged(browser):
    """A frame that cannot be read is a message, and is left out while frames are played; the last of two clicks counts."""
    (work / "damaged.dump").write_text("".join([frames[0], frames[1].replace("\n5 1 ", "\n5 none "), frames[2]]))
    with shown(browser, "damaged.dump", *FAST):
        choose(browser, "frame", "2")
        settle(browser, problem="none")
        browser.run("document.getElementById('undo').click()")
        settle(browser)
        browser.wait("return document.querySelector('#errors .toast') === null")
        browser.run("document.getElementById('play').click()")
        browser.wait("return [...document.querySelectorAll('#errors .toast')].some(t => t.textContent.includes('none'))")
        browser.wait("return document.getElementById('frame').value === '3'", pause=0.001)
        browser.run("document.getElementById('play').click()")
        settle(browser)
        browser.run("for (const value of ['1', '3', '1', '3']) { const f = document.getElementById('frame'); f.value = value; f.dispatchEvent(new Event('change')); }")
        wait_for_command(browser, "--frame 3")
        check_command(browser, "last")


def view_scene(browser):
    with shown(browser, str(FINAL), "--width", "192", "--height", "108", "--samples", "4", size=(1600, 900)):
        look(browser, "final", [("set", "render.seed=7\nbackground.type=constant")])
        browser.wait("return document.querySelectorAll('.object').length > 100")
        browser.run("const o = [...document.querySelectorAll('.object')].find(o => o.dataset.name === 'material.ground');"
                    "o.open = true;")
        browser.wait("return document.querySelector('[aria-label=\"material.ground.albedo\"]')")
        browser.run("const f = document.querySelector('[aria-label=\"material.ground.albedo\"]');"
                    "f.value = '[0.9, 0.1, 0.1]'; f.dispatchEvent(new Event('change'))")
        wait_for_command(browser, "material.ground.albedo=[0.9, 0.1, 0.1]")
        check_command(browser, "final-material")
        browser.run("document.getElementById('undo').click()")
        wait_for_command(browser, "material.ground.albedo", False)
        browser.wait("return document.querySelector('[aria-label=\"material.ground.albedo\"]').value !== '[0.9, 0.1, 0.1]'")
        browser.resize(400, 900)
        expect(browser.run("return document.documentElement.scrollWidth <= innerWidth"), "too wide")


WALKS = {
    "controls": use_controls, "legend": keep_legend, "random": walk_at_random, "tasks": do_tasks, "dark": never_black, "tabs": use_tabs, "audit": audit,
    "scene": view_scene, "hostile": view_hostile, "damaged": view_damaged, "window": fill_window,
}
browser, failed = Browser(), []
try:
    for walk in sys.argv[3:]:
        begin = time.monotonic()
        try:
            WALKS[walk](browser)
        except Exception:  # the others can tell more
            traceback.print_exc()
            browser.screenshot(work / f"{walk}.failed.png")
            failed.append(walk)
        print(f"{walk}: {time.monotonic() - begin:.1f} s", flush=True)
finally:
    browser.close()
expect(not failed, f"failed: {failed}")
