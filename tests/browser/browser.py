# SPDX-License-Identifier: Apache-2.0
"""Selenium's Chromium as the tests of the page want it: headless, sized in CSS pixels, light or dark; with waits for what the page itself
tells, pointers at points of the map, and what a screen reader is told."""

import base64
import pathlib
import time

from selenium.webdriver import ActionChains, Chrome, ChromeOptions
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.actions.action_builder import ActionBuilder
from selenium.webdriver.common.by import By

ARGUMENTS = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars", "--no-first-run",
             "--disable-extensions", "--lang=en-GB"]
STROKE_MS = 60


class Browser(Chrome):
    """Ends with the `with` block, or by quit()."""

    def __init__(self, width=1280, height=800, dark=False, mobile=False):
        options = ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        for argument in [*ARGUMENTS, f"--window-size={width},{height}"]:
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        options.ignore_local_proxy_environment_variables()
        super().__init__(service=Service("/usr/bin/chromedriver"), options=options)
        self.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": mobile})
        colours = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [colours]})

    def wait(self, condition, patience_s=10.0):
        """Until the expression of JavaScript is true; how long that took, in s."""
        began = time.monotonic()
        while not self.execute_script(f"return Boolean({condition})"):
            if time.monotonic() - began > patience_s:
                raise TimeoutError(f"not within {patience_s} s: {condition}")
            time.sleep(0.02)
        return time.monotonic() - began

    def press(self, selector, key):
        """A key, with the focus on an element."""
        self.execute_script("arguments[0].focus()", self.find_element(By.CSS_SELECTOR, selector))
        ActionChains(self).key_down(key).key_up(key).perform()

    def hand(self, *strokes, kind="mouse"):
        """What pointers do, stroke by stroke: {finger: (x, y)} goes there, {finger: "down"}, {finger: "up"}. What is down stays down for the next call."""
        actions = ActionBuilder(self)
        for finger in sorted({finger for stroke in strokes for finger in stroke}):
            pointer = actions.add_pointer_input(kind, f"{kind}{finger}")
            for stroke in (stroke.get(finger) for stroke in strokes):
                if stroke is None:
                    pointer.create_pause(0)
                elif stroke == "down":
                    pointer.create_pointer_down(button=0)
                elif stroke == "up":
                    pointer.create_pointer_up(button=0)
                else:
                    pointer.create_pointer_move(STROKE_MS, *stroke)
        actions.perform()

    def save_whole_page(self, file):
        """A screenshot of all that could be scrolled to."""
        pathlib.Path(file).write_bytes(base64.b64decode(self.execute_cdp_cmd("Page.captureScreenshot", {"captureBeyondViewport": True})["data"]))

    def accessibility_tree(self):
        """What a screen reader is told: role, name, and whether it takes the focus, of every node that it hears of."""
        self.execute_cdp_cmd("Accessibility.enable", {})
        nodes = []
        for node in self.execute_cdp_cmd("Accessibility.getFullAXTree", {})["nodes"]:
            if node.get("ignored"):
                continue
            value = lambda key: str(node.get(key, {}).get("value", ""))
            properties = {one["name"]: one["value"].get("value") for one in node.get("properties", [])}
            nodes.append({"role": value("role"), "name": value("name").strip(), "properties": properties})
        return nodes

    def errors(self):
        """What the console has said since the last call, as far as it is an error or a warning."""
        return [entry["message"] for entry in self.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]
