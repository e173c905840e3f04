# SPDX-License-Identifier: Apache-2.0
"""Drives Chromium by WebDriver's HTTP protocol (W3C), with nothing but the standard library."""

import base64
import json
import subprocess
import tempfile
import time
import urllib.error
import urllib.request


class WebDriverError(RuntimeError):
    """What the driver or the page refused."""


class Browser:
    """A headless Chromium with its driver; ends with the `with` block."""

    def __init__(self, width=1280, height=800, dark=False, mobile=False):
        self.profile = tempfile.TemporaryDirectory()
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.base = f"http://127.0.0.1:{self._port()}"
        arguments = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars",
                     "--no-first-run", "--disable-extensions", "--lang=en-GB",
                     f"--user-data-dir={self.profile.name}", f"--window-size={width},{height}"]
        options = {"args": arguments, "binary": "/usr/bin/chromium"}
        capabilities = {"browserName": "chrome", "goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}
        self.session = self._call("POST", "/session", {"capabilities": {"alwaysMatch": capabilities}})["sessionId"]
        self.resize(width, height, mobile)
        self.set_dark(dark)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self._call("DELETE", f"/session/{self.session}")
        except (WebDriverError, OSError):
            pass
        self.driver.terminate()
        self.driver.wait(10)
        self.driver.stdout.close()
        self.profile.cleanup()

    def _port(self):
        for line in self.driver.stdout:
            if "successfully on port" in line:
                return int(line.rstrip(".\n ").rsplit(" ", 1)[1])
        raise WebDriverError("chromedriver did not start")

    def _call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.base + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise WebDriverError(json.load(error)["value"]["message"]) from error

    def _devtools(self, command, **parameters):
        return self._call("POST", f"/session/{self.session}/goog/cdp/execute", {"cmd": command, "params": parameters})

    def resize(self, width, height, mobile=False):
        """The page itself gets this size, in CSS pixels."""
        self._devtools("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=mobile)

    def set_dark(self, dark):
        value = "dark" if dark else "light"
        self._devtools("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": value}])

    def open(self, url):
        self._call("POST", f"/session/{self.session}/url", {"url": url})

    def run(self, script, *arguments):
        """The value of `return …`."""
        return self._call("POST", f"/session/{self.session}/execute/sync", {"script": script, "args": list(arguments)})

    def wait(self, condition, patience_s=10.0):
        """Until the expression is true; how long that took, in s."""
        began = time.monotonic()
        while not self.run(f"return Boolean({condition})"):
            if time.monotonic() - began > patience_s:
                raise WebDriverError(f"not within {patience_s} s: {condition}")
            time.sleep(0.02)
        return time.monotonic() - began

    def press(self, selector, key):
        """A key, with the focus on an element."""
        self.run("document.querySelector(arguments[0]).focus()", selector)
        actions = [{"type": "keyDown", "value": key}, {"type": "keyUp", "value": key}]
        self._call("POST", f"/session/{self.session}/actions",
                   {"actions": [{"type": "key", "id": "keys", "actions": actions}]})

    def accessibility_tree(self):
        """What a screen reader is told: role, name, and whether it takes the focus, of every node that it hears of."""
        self._devtools("Accessibility.enable")
        nodes = []
        for node in self._devtools("Accessibility.getFullAXTree")["nodes"]:
            if node.get("ignored"):
                continue
            value = lambda key: str(node.get(key, {}).get("value", ""))
            properties = {one["name"]: one["value"].get("value") for one in node.get("properties", [])}
            nodes.append({"role": value("role"), "name": value("name").strip(), "properties": properties})
        return nodes

    def keys(self, *strokes):
        """Keys that go down or up in whatever has the focus: ("down", "a"), ("up", "a"), and pauses ("wait", seconds)."""
        actions = [{"type": "pause", "duration": round(1000 * value)} if kind == "wait"
                   else {"type": "keyDown" if kind == "down" else "keyUp", "value": value} for kind, value in strokes]
        self._call("POST", f"/session/{self.session}/actions", {"actions": [{"type": "key", "id": "keys", "actions": actions}]})

    def drag(self, start, end):
        """The mouse, from one point of the page to another."""
        actions = [{"type": "pointerMove", "duration": 0, "x": start[0], "y": start[1]}, {"type": "pointerDown", "button": 0},
                   {"type": "pointerMove", "duration": 100, "x": end[0], "y": end[1]}, {"type": "pointerUp", "button": 0}]
        self._call("POST", f"/session/{self.session}/actions",
                   {"actions": [{"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": actions}]})

    def hand(self, *strokes, kind="mouse"):
        """What pointers do, stroke by stroke: {finger: (x, y)} goes there, {finger: "down"}, {finger: "up"}. What is down stays down for the next call."""
        def action(stroke):
            if stroke is None:
                return {"type": "pause", "duration": 0}
            if isinstance(stroke, str):
                return {"type": "pointerDown" if stroke == "down" else "pointerUp", "button": 0}
            return {"type": "pointerMove", "duration": 60, "x": stroke[0], "y": stroke[1]}
        fingers = sorted({finger for stroke in strokes for finger in stroke})
        self._call("POST", f"/session/{self.session}/actions",
                   {"actions": [{"type": "pointer", "id": f"{kind}{finger}", "parameters": {"pointerType": kind},
                                 "actions": [action(stroke.get(finger)) for stroke in strokes]} for finger in fingers]})

    def move(self, point):
        actions = [{"type": "pointerMove", "duration": 0, "x": point[0], "y": point[1]}]
        self._call("POST", f"/session/{self.session}/actions",
                   {"actions": [{"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": actions}]})

    def screenshot(self, file, whole=False):
        if whole:
            picture = self._devtools("Page.captureScreenshot", captureBeyondViewport=True)["data"]
        else:
            picture = self._call("GET", f"/session/{self.session}/screenshot")
        with open(file, "wb") as out:
            out.write(base64.b64decode(picture))

    def errors(self):
        """What the console has said since the last call, as far as it is an error or a warning."""
        entries = self._call("POST", f"/session/{self.session}/se/log", {"type": "browser"})
        return [entry["message"] for entry in entries if entry["level"] in ("SEVERE", "WARNING")]
