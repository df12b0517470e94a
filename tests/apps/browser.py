# SPDX-License-Identifier: Apache-2.0
"""A page in headless Chromium, for checks that look at pages."""
import json
import pathlib
import time

from cases import Skip

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.keys import Keys
except ImportError:
    webdriver = Keys = None

DRIVER, CHROMIUM = pathlib.Path("/usr/bin/chromedriver"), pathlib.Path("/usr/bin/chromium")


class Browser:
    """Chromium with a page; software draws its WebGL, and no name of a host resolves."""

    def __init__(self, page, width=1400, dark=False, webgl=True):
        if webdriver is None or not DRIVER.exists() or not CHROMIUM.exists():
            raise Skip("no chromium, chromium-driver or python3-selenium")
        options = Options()
        options.binary_location = str(CHROMIUM)
        for flag in ("--headless=new", "--no-sandbox", "--hide-scrollbars", "--host-resolver-rules=MAP * ~NOTFOUND",
                     f"--window-size={width},900"):
            options.add_argument(flag)
        for flag in ("--use-angle=swiftshader", "--enable-unsafe-swiftshader") if webgl else ("--disable-3d-apis",):
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        try:
            self.driver = webdriver.Chrome(options=options, service=Service(str(DRIVER)))
        except Exception as why:  # noqa: BLE001 - whatever keeps a browser from starting
            raise Skip(f"Chromium does not start: {str(why).splitlines()[0]}") from why
        self.driver.set_script_timeout(60)
        self.cdp("Emulation.setDeviceMetricsOverride", width=width, height=844, deviceScaleFactor=1, mobile=width < 500)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.cdp("Emulation.setEmulatedMedia", features=[scheme])
        self.driver.get(pathlib.Path(page).as_uri())
        end = time.monotonic() + 20
        while self.js("return document.body.dataset.ready") != "true" and time.monotonic() < end:
            time.sleep(0.05)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.driver.quit()

    def cdp(self, command, **arguments):
        return self.driver.execute_cdp_cmd(command, arguments)

    def js(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def seconds(self):
        return float(self.js("return document.getElementById('player').dataset.seconds"))

    def press(self, *keys):
        body = self.driver.find_element("tag name", "body")
        for key in keys:
            body.send_keys(key)

    def faults(self):
        """Messages of the console that are no hints, and requests for anything but the page."""
        said = [line["message"] for line in self.driver.get_log("browser") if line["level"] != "INFO"]
        for line in self.driver.get_log("performance"):
            message = json.loads(line["message"])["message"]
            if message["method"] != "Network.requestWillBeSent":
                continue
            url = message["params"]["request"]["url"]
            if url.startswith(("data:", "chrome:", "about:")) or url == self.driver.current_url:
                continue
            said.append(f"request: {url}")
        return said
