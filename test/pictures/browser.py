"""A browser for tests of the player."""

import base64
import os
import shutil
import tempfile

import numpy as np
import pytest

DRIVERS = ("/usr/bin/chromedriver", "/usr/lib/chromium-browser/chromedriver")
SWITCHES = ("--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
            "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run",
            "--hide-scrollbars")
WIDTH, HEIGHT = 1280, 800


def driver_path():
    """Return the path of Chromium's driver; skip the test where there is none."""
    for path in DRIVERS:
        if os.path.exists(path):
            return path
    found = shutil.which("chromedriver")
    if not found:
        pytest.skip("Chromium's driver is not installed (Debian package chromium-driver)")
    return found


class Browser:
    """Chromium without a window, drawing by software."""

    def __init__(self):
        webdriver = pytest.importorskip("selenium.webdriver", reason="python3-selenium is not installed")
        from selenium.webdriver.chrome.service import Service
        service = Service(driver_path())
        self.folder = tempfile.mkdtemp(prefix="flexarm_browser_")
        options = webdriver.ChromeOptions()
        for switch in (*SWITCHES, f"--window-size={WIDTH},{HEIGHT}", f"--user-data-dir={self.folder}/profile"):
            options.add_argument(switch)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=service, options=options)
        self.driver.set_script_timeout(600)
        self.resize(WIDTH, HEIGHT)

    def skip_unless_it_draws(self):
        """Skip the test if this Chromium has no WebGL by software."""
        if not self.run("return Boolean(document.createElement('canvas').getContext('webgl'))"):
            pytest.skip("this Chromium cannot draw by software (WebGL)")

    def quit(self):
        self.driver.quit()
        shutil.rmtree(self.folder, ignore_errors=True)

    def resize(self, width, height, is_mobile=False):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": is_mobile})

    def open(self, path):
        """Open a page and wait until its first picture is drawn. Return the messages of its console."""
        self.driver.get(path if "://" in path else f"file://{path}")
        self.wait("flexarm.ready")
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] != "INFO"]

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def wait(self, promise):
        """Return what a promise is fulfilled with. @param promise  an expression in JavaScript"""
        result = self.driver.execute_async_script(f"""const done = arguments[0];
            ({promise}).then((value) => done({{value}}), (error) => done({{error: String(error)}}))""")
        assert "error" not in result, result["error"]
        return result.get("value")

    def until(self, condition, seconds=20):
        """Wait until an expression is true. Return its value."""
        return self.wait(f"""new Promise((resolve, reject) => {{
            const end = performance.now() + {1000 * seconds};
            const look = () => {{
              const value = {condition};
              if (value) resolve(value);
              else if (performance.now() > end) reject(new Error("not true in time: " + {condition!r}));
              else setTimeout(look, 30);
            }};
            look();
          }})""")

    def frame(self):
        """Wait until what was asked for is drawn."""
        self.wait("""new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() =>
            requestAnimationFrame(done))))""")

    def click(self, selector, index=0):
        self.driver.find_elements("css selector", selector)[index].click()

    def text(self, selector):
        return self.run("return document.querySelector(arguments[0]).textContent", selector)

    def is_visible(self, selector):
        return self.run("""const element = document.querySelector(arguments[0]);
            return Boolean(element && element.getClientRects().length)""", selector)

    def capture(self, width, height, caption=""):
        """Return a captured picture as the bytes of a PNG file."""
        self.driver.execute_script("window.captionOfTest = arguments[0]", caption)
        url = self.wait(f"""flexarm.capture({width}, {height}, window.captionOfTest).then((blob) =>
            new Promise((done) => {{
              const reader = new FileReader();
              reader.onload = () => done(reader.result);
              reader.readAsDataURL(blob);
            }}))""")
        head, data = url.split(",")
        assert head == "data:image/png;base64"
        return base64.b64decode(data)

    def pixels(self, png):
        """Return the pixels of a PNG file as rows of red, green and blue. The browser decodes it."""
        self.driver.execute_script("window.pictureOfTest = arguments[0]", base64.b64encode(png).decode())
        width, height, data = self.wait("""new Promise((done) => {
            const image = new Image();
            image.onload = () => {
              const canvas = document.createElement("canvas");
              canvas.width = image.width;
              canvas.height = image.height;
              const context = canvas.getContext("2d");
              context.drawImage(image, 0, 0);
              const bytes = context.getImageData(0, 0, image.width, image.height).data;
              let text = "";
              for (let k = 0; k < bytes.length; k += 8192) text += String.fromCharCode(...bytes.subarray(k, k + 8192));
              done([image.width, image.height, btoa(text)]);
            };
            image.src = "data:image/png;base64," + window.pictureOfTest;
          })""")
        return np.frombuffer(base64.b64decode(data), dtype=np.uint8).reshape(height, width, 4)[:, :, :3].astype(int)

    def screen(self):
        """Return the pixels of the canvas as they are on the screen, with all that lies over it."""
        return self.pixels(self.driver.find_element("id", "picture").screenshot_as_png)
