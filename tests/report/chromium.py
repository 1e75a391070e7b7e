# SPDX-License-Identifier: MIT
"""A page in a headless Chromium, driven by the DevTools protocol over two pipes."""
import base64
import json
import os
import select
import shutil
import subprocess
import tempfile
import time


def find():
    """Path of a Chromium, or None."""
    for name in ("chromium", "chromium-browser", "google-chrome"):
        path = shutil.which(name)
        if path:
            return path
    return None


class Browser:
    """One page. What it logs as an error, throws or asks the network for stands in `problems`."""

    def __init__(self, program, width=1280, height=900, dark=False, limit_s=300.0, flags=()):
        self._profile = tempfile.mkdtemp(prefix="raymoval-chromium-")
        self._deadline = time.monotonic() + limit_s
        to_read, self._write = os.pipe()
        self._read, to_write = os.pipe()

        def place():  # DevTools reads from descriptor 3 and writes to 4.
            high_read, high_write = os.dup(to_read), os.dup(to_write)
            os.dup2(high_read, 3)
            os.dup2(high_write, 4)

        self._process = subprocess.Popen(
            [program, "--headless=new", "--remote-debugging-pipe", "--no-sandbox", "--no-first-run",
             "--disable-dev-shm-usage", "--disable-background-networking", "--hide-scrollbars",
             "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
             f"--user-data-dir={self._profile}", f"--window-size={width},{height}", *flags,
             "about:blank"],
            preexec_fn=place, close_fds=False, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL, start_new_session=True)
        os.close(to_read)
        os.close(to_write)
        self._buffer = b""
        self._count = 0
        self._session = None
        self.problems = []
        targets = self.call("Target.getTargets")["targetInfos"]
        page = next(target for target in targets if target["type"] == "page")
        attached = self.call("Target.attachToTarget", targetId=page["targetId"], flatten=True)
        self._session = attached["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=1, mobile=False)
        self.set_dark(dark)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self._write)
        try:
            self._process.wait(timeout=5)
        except subprocess.TimeoutExpired:
            os.killpg(self._process.pid, 9)
            self._process.wait()
        os.close(self._read)
        shutil.rmtree(self._profile, ignore_errors=True)

    def _note(self, message):
        method, params = message.get("method", ""), message.get("params", {})
        if method == "Runtime.exceptionThrown":
            self.problems.append("exception: " + json.dumps(params["exceptionDetails"])[:600])
        elif method == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning", "assert"):
            texts = [str(part.get("value", part.get("description"))) for part in params["args"]]
            self.problems.append("console: " + " ".join(texts)[:600])
        elif method == "Log.entryAdded" and params["entry"]["level"] == "error":
            self.problems.append("log: " + params["entry"]["text"][:600])
        elif method == "Network.requestWillBeSent":
            url = params["request"]["url"]
            if not url.startswith(("file:", "data:", "blob:", "about:")):
                self.problems.append("network: " + url[:200])

    def _receive(self):
        while b"\0" not in self._buffer:
            left = self._deadline - time.monotonic()
            if left <= 0 or not select.select([self._read], [], [], left)[0]:
                raise TimeoutError("Chromium does not answer")
            piece = os.read(self._read, 1 << 20)
            if not piece:
                raise RuntimeError("Chromium ended")
            self._buffer += piece
        message, self._buffer = self._buffer.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, **params):
        """One command of the protocol; gives its result."""
        self._count += 1
        command = {"id": self._count, "method": method, "params": params}
        if self._session:
            command["sessionId"] = self._session
        os.write(self._write, json.dumps(command).encode() + b"\0")
        while True:
            message = self._receive()
            self._note(message)
            if message.get("id") == self._count:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']}")
                return message["result"]

    def open(self, path):
        """Opens a file and waits for the page. Gives the seconds it took."""
        started = time.monotonic()
        if not os.path.exists(path):
            raise FileNotFoundError(path)
        self.call("Page.navigate", url="file://" + os.path.abspath(path))
        self.wait("document.readyState === 'complete' && location.protocol === 'file:'")
        return time.monotonic() - started

    def run(self, script):
        """Value of an expression; a promise is waited for."""
        answer = self.call("Runtime.evaluate", expression=script, returnByValue=True,
                           awaitPromise=True)
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise RuntimeError(details.get("exception", {}).get("description", details["text"]))
        return answer["result"].get("value")

    def wait(self, script):
        """Until an expression is true."""
        while not self.run(script):
            if time.monotonic() > self._deadline:
                raise TimeoutError("never true: " + script)
            time.sleep(0.02)

    def set_dark(self, dark):
        self.call("Emulation.setEmulatedMedia", features=[
            {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])

    def low_contrast(self):
        """Texts with a contrast below 4.5 to their background (WCAG 2, formula of relative luminance)."""
        return self.run(r"""(() => {
          const part = (value) => value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
          const light = (text) => { const [r, g, b] = text.match(/[\d.]+/g).map((value) => part(value / 255));
                                    return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
          const ground = (node) => { for (; node; node = node.parentElement) {
            const colour = getComputedStyle(node).backgroundColor;
            if (/^rgb\(/.test(colour)) return colour; } return 'rgb(255, 255, 255)'; };
          return [...document.querySelectorAll('body *')].filter((node) => node.checkVisibility()
              && !node.closest('svg, canvas, .heat') && [...node.childNodes].some(
                  (child) => child.nodeType === 3 && child.textContent.trim())).flatMap((node) => {
            const [a, b] = [light(getComputedStyle(node).color), light(ground(node))].sort((x, y) => y - x);
            const ratio = (a + 0.05) / (b + 0.05);
            return ratio < 4.5 ? [node.tagName + ' ' + node.textContent.slice(0, 20) + ' ' + ratio] : [];
          });
        })()""")

    def press(self, key):
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key,
                  text=key if len(key) == 1 else "")
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key)

    def click(self, x, y):
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def drag(self, start, end, button="left"):
        self.call("Input.dispatchMouseEvent", type="mousePressed", x=start[0], y=start[1],
                  button=button, clickCount=1)
        for kind in ("mouseMoved", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=end[0], y=end[1], button=button,
                      buttons={"left": 1, "right": 2}[button] if kind == "mouseMoved" else 0,
                      clickCount=1)

    def touch(self, *steps):
        """Fingers that are put down at the places of the first step, and move to those of the others."""
        for kind, places in zip(["touchStart"] + ["touchMove"] * len(steps), steps):
            self.call("Input.dispatchTouchEvent", type=kind, touchPoints=[
                {"x": x, "y": y, "id": i} for i, (x, y) in enumerate(places)])
        self.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    def screenshot(self, path, whole=False):
        picture = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)
        with open(path, "wb") as file:
            file.write(base64.b64decode(picture["data"]))
