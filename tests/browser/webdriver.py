# SPDX-License-Identifier: Apache-2.0
"""The part of the WebDriver protocol that the browser tests use, over chromedriver and without other packages."""
import base64
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request

# Nothing is asked from the network: there may be none.
CAPABILITIES = {"alwaysMatch": {
    "goog:chromeOptions": {"args": ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                                    "--no-first-run", "--disable-background-networking", "--disable-component-update",
                                    "--disable-sync"]},
    "goog:loggingPrefs": {"browser": "ALL"}}}


def exit_if_missing():
    """Skips the test if there is no browser."""
    if not shutil.which("chromium") or not shutil.which("chromedriver"):
        print("chromium or chromedriver is not installed; apt-get install chromium chromium-driver")
        sys.exit(77)


def free_port():
    with socket.socket() as server:
        server.bind(("127.0.0.1", 0))
        return server.getsockname()[1]


class Browser:
    """A headless Chromium whose page has this size, in CSS pixels."""

    def __init__(self, width=1400, height=900, dark=False):
        self._port = free_port()
        # A separate session, so that the browser ends with its driver whatever happens to the driver.
        self._driver = subprocess.Popen(["chromedriver", f"--port={self._port}", "--silent"], start_new_session=True,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            self._wait_for_driver()
            self._session = self._call("POST", "/session", {"capabilities": CAPABILITIES})["sessionId"]
        except Exception:
            self._kill()
            raise
        self.renew(width, height, dark)

    def renew(self, width=1400, height=900, dark=False):
        """Closes all pages, and opens an empty one of this size."""
        old = self.tabs()
        new = self.new_tab()
        for handle in old:
            self.switch(handle)
            self._request("DELETE", "/window")
        self.switch(new)
        self.errors()  # of the pages before
        # Windows cannot be as narrow as that of a phone.
        self.resize(width, height)
        self.dark(dark)

    def dark(self, is_dark):
        scheme = {"name": "prefers-color-scheme", "value": "dark" if is_dark else "light"}
        self._devtools("Emulation.setEmulatedMedia", features=[scheme])

    def _devtools(self, command, **parameters):
        self._request("POST", "/goog/cdp/execute", {"cmd": command, "params": parameters})

    def close(self):
        try:
            self._request("DELETE", "")
        finally:
            self._kill()

    def _wait_for_driver(self):
        for _ in range(600):
            try:
                if self._call("GET", "/status")["ready"]:
                    return
            except urllib.error.HTTPError:
                raise
            except (ConnectionError, urllib.error.URLError):
                time.sleep(0.1)
        raise RuntimeError("chromedriver does not answer")

    def _kill(self):
        os.killpg(self._driver.pid, signal.SIGKILL)
        self._driver.wait()

    def _call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(f"http://127.0.0.1:{self._port}{path}", data=data, method=method,
                                         headers={"Content-Type": "application/json"})
        with urllib.request.urlopen(request, timeout=120) as answer:
            return json.load(answer)["value"]

    def _request(self, method, path, body=None):
        return self._call(method, f"/session/{self._session}{path}", body)

    def open(self, url):
        self._request("POST", "/url", {"url": url})

    def reload(self):
        """Returns when the page has been loaded again: a script that reloads it would return before."""
        self._request("POST", "/refresh", {})

    def run(self, script, *arguments):
        """Runs JavaScript and returns its result."""
        return self._request("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def run_async(self, script, *arguments):
        """Runs JavaScript whose last argument is a function, and returns what that function is called with."""
        return self._request("POST", "/execute/async", {"script": script, "args": list(arguments)})

    def wait(self, script, *arguments, tries=3000, pause=None):
        """Runs JavaScript until its result is true, and returns it. The number of tries ends a test that hangs.

        Looks again after `pause` seconds, without it soon at first. A script may fail while the page is being replaced.
        """
        failure = ""
        for number in range(tries):
            try:
                if result := self.run(script, *arguments):
                    return result
            except urllib.error.HTTPError as error:
                failure = error.read().decode(errors="replace")
            time.sleep(min(0.01 * number, 0.1) if pause is None else pause)
        raise AssertionError(f"never true: {script}\n{failure}")

    def act(self, *sources):
        self._request("POST", "/actions", {"actions": list(sources)})

    def drag(self, start, end, steps=8, button=0, key=None, release=True):
        """Drags the mouse from one position in the window to another."""
        moves = [{"type": "pointerMove", "duration": 30, "x": round(start[0] + (end[0] - start[0]) * i / steps),
                  "y": round(start[1] + (end[1] - start[1]) * i / steps)} for i in range(steps + 1)]
        actions = [moves[0], {"type": "pointerDown", "button": button}, *moves[1:]]
        if release:
            actions.append({"type": "pointerUp", "button": button})
        sources = [{"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": actions}]
        if key:
            held = [{"type": "keyDown", "value": key}, *[{"type": "pause"}] * len(actions), {"type": "keyUp", "value": key}]
            sources[0]["actions"] = [{"type": "pause"}, *actions]
            sources.append({"type": "key", "id": "keys", "actions": held})
        self.act(*sources)

    def click(self, x, y, count=1):
        press = [{"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0}] * count
        self.act({"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"},
                  "actions": [{"type": "pointerMove", "duration": 0, "x": x, "y": y}, *press]})

    def wheel(self, x, y, delta):
        self.act({"type": "wheel", "id": "wheel",
                  "actions": [{"type": "scroll", "x": x, "y": y, "deltaX": 0, "deltaY": delta}]})

    def keys(self, text):
        actions = [action for c in text for action in ({"type": "keyDown", "value": c}, {"type": "keyUp", "value": c})]
        self.act({"type": "key", "id": "keys", "actions": actions})

    def keys_with(self, held, text):
        """Presses keys while another one is held."""
        actions = [{"type": "keyDown", "value": held}]
        for c in text:
            actions += [{"type": "keyDown", "value": c}, {"type": "keyUp", "value": c}]
        self.act({"type": "key", "id": "keys", "actions": [*actions, {"type": "keyUp", "value": held}]})

    def resize(self, width, height, pixels=1):
        """Sets the size of the page in CSS pixels, and the pixels of the screen for each of them."""
        self._devtools("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=pixels, mobile=False)

    def screenshot(self, file):
        with open(file, "wb") as out:
            out.write(base64.b64decode(self._request("GET", "/screenshot")))

    def download(self, folder, name, button):
        """Clicks a button that downloads a file of this name, and returns the file."""
        self._devtools("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(folder))
        file = folder / name
        file.unlink(missing_ok=True)
        self.run("document.querySelector(arguments[0]).click()", button)
        for _ in range(3000):
            if file.exists():  # under this name only when it is complete
                return file
            time.sleep(0.1)
        raise AssertionError(f"{name} is not downloaded")

    def errors(self):
        """Messages of the browser's console that are errors."""
        return [entry["message"] for entry in self._request("POST", "/se/log", {"type": "browser"})
                if entry["level"] == "SEVERE"]

    def new_tab(self):
        handle = self._request("POST", "/window/new", {"type": "tab"})["handle"]
        self._request("POST", "/window", {"handle": handle})
        return handle

    def tabs(self):
        return self._request("GET", "/window/handles")

    def switch(self, handle):
        self._request("POST", "/window", {"handle": handle})

    def enter_frame(self, index):
        self._request("POST", "/frame", {"id": index})
