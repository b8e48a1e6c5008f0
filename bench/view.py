#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures how fast `orrery view` answers in Chromium on this machine.

    bench/view.py ORRERY FILE [OPTION...]

OPTION are options of `orrery view`. Prints a line for each measurement: the time from a move of the mouse to changed
pixels (median and 95th percentile of 60 moves), images per second and their size during a drag, the time from the end of
a drag to the complete image, and for data files the time from a change of a control to the first image.
"""
import pathlib
import statistics
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests/browser"))
from webdriver import Browser, exit_if_missing

SETTLED = "const { settled, shown } = document.getElementById('picture').dataset; return settled === 'true' && shown"

# Sends moves of the pointer, each when the image of the one before is shown; returns the times in ms.
MOVES = """
const done = arguments[arguments.length - 1], canvas = document.getElementById('picture');
const box = canvas.getBoundingClientRect(), times = [];
const send = (type, x) => canvas.dispatchEvent(new PointerEvent(type, {
  pointerId: 1, clientX: x, clientY: box.top + box.height / 2, button: type === 'pointermove' ? -1 : 0, buttons: 1,
  bubbles: true }));
canvas.setPointerCapture = () => {};
let x = box.left + box.width / 2, begin = 0, asked = 0;
send('pointerdown', x);
const move = () => { asked = Number(canvas.dataset.asked); begin = performance.now(); x += 5; send('pointermove', x); };
new MutationObserver((changes, observer) => {
  if (!changes.some(c => c.attributeName === 'data-shown') || Number(canvas.dataset.shown) <= asked) return;
  times.push(performance.now() - begin);
  if (times.length < 60) return requestAnimationFrame(move);
  observer.disconnect();
  send('pointerup', x);
  done(times);
}).observe(canvas, { attributes: true });
move();
"""

# Moves the pointer at 60 Hz for three seconds; returns the number of images that were shown.
DRAG = """
const done = arguments[arguments.length - 1], canvas = document.getElementById('picture');
const box = canvas.getBoundingClientRect(), first = Number(canvas.dataset.frame);
const send = (type, x) => canvas.dispatchEvent(new PointerEvent(type, {
  pointerId: 1, clientX: x, clientY: box.top + box.height / 2, button: type === 'pointermove' ? -1 : 0, buttons: 1,
  bubbles: true }));
canvas.setPointerCapture = () => {};
let x = box.left + 50;
send('pointerdown', x);
const begin = performance.now(), timer = setInterval(() => {
  send('pointermove', x += 2);
  if (performance.now() - begin < 3000) return;
  clearInterval(timer);
  const images = Number(canvas.dataset.frame) - first, seconds = (performance.now() - begin) / 1000;
  const size = canvas.dataset.size, end = performance.now();
  send('pointerup', x);
  const wait = setInterval(() => {
    if (canvas.dataset.settled !== 'true') return;
    clearInterval(wait);
    done([images / seconds, size, performance.now() - end]);
  }, 5);
}, 16);
"""

# Changes a control; returns the time to the first image in ms.
CHANGE = """
const [selector, value, done] = arguments, canvas = document.getElementById('picture');
const field = document.querySelector(selector), asked = Number(canvas.dataset.asked), begin = performance.now();
new MutationObserver((changes, observer) => {
  if (Number(canvas.dataset.shown) <= asked) return;
  observer.disconnect();
  done(performance.now() - begin);
}).observe(canvas, { attributes: true });
if (field.type === 'radio') return field.click();
field.value = value;
field.dispatchEvent(new Event('change'));
"""


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    exit_if_missing()
    begin = time.monotonic()
    program = subprocess.Popen([sys.argv[1], "view", *sys.argv[2:]], stdout=subprocess.PIPE, text=True)
    browser = None
    try:
        url = program.stdout.readline().strip()
        browser = Browser(width=1400, height=900)
        opened = time.monotonic()
        browser.open(url)
        browser.wait("return document.getElementById('status').textContent !== 'Starting'", pause=0.01)
        print(f"start to the first words in the page: {time.monotonic() - opened:.2f} s")
        browser.wait("return document.getElementById('picture').dataset.frame", pause=0.01)
        print(f"start of the program to the first image: {time.monotonic() - begin:.2f} s")
        browser.wait(SETTLED, pause=0.01)
        print(f"start of the program to the complete image: {time.monotonic() - begin:.2f} s")
        times = browser.run_async(MOVES)
        print(f"move to pixels: median {statistics.median(times):.0f} ms, "
              f"95th percentile {statistics.quantiles(times, n=20)[-1]:.0f} ms")
        browser.wait(SETTLED, pause=0.01)
        rate, size, complete = browser.run_async(DRAG)
        print(f"drag: {rate:.1f} images/s of {size}; complete image after {complete / 1000:.2f} s")
        if browser.run("return document.getElementById('style') !== null"):
            for control, values in (("--map", ("magma", "viridis")), ("#range", ("0:1", "0:2")), ("--style", ("flat", "ambient")),
                                    ("#radius-scale", ("0.9", "1.1"))):
                for value in values:
                    browser.wait(SETTLED, pause=0.01)
                    selector = control if control.startswith("#") else f"input[name='{control}'][value='{value}']"
                    print(f"{control} {value} to the first image: {browser.run_async(CHANGE, selector, value):.0f} ms")
        sizes = browser.run("return performance.getEntriesByType('resource').concat("
                            "performance.getEntriesByType('navigation')).filter(e => !/frame|wish|state|pick|column|bounds/.test(e.name))"
                            ".map(e => e.transferSize)")
        print(f"transferred bytes without images and states: {sum(sizes)}")
    finally:
        if browser:
            browser.close()
        program.terminate()
        program.wait()


main()
