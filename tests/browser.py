# SPDX-License-Identifier: GPL-3.0-or-later
"""A headless Chromium that tests open pages in, by its DevTools protocol."""
import asyncio
import atexit
import base64
import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
import urllib.request

CHROMIUM = shutil.which("chromium")
try:
    import websockets
except ImportError:
    websockets = None
MISSING = None if CHROMIUM and websockets else "no chromium, or no python3-websockets, is installed"


async def connected(address):
    return await websockets.connect(address, max_size=None, ping_interval=None)


class Browser:
    """One tab. `errors` and `requests` gather what pages complain of and ask for."""

    def __init__(self, width=1200, height=900, dark=False, webgl=True):
        self.folder = tempfile.TemporaryDirectory(prefix="craquelure-browser-", ignore_cleanup_errors=True)
        drawing = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"] if webgl else \
            ["--disable-gpu", "--disable-3d-apis"]
        self.process = subprocess.Popen(
            [CHROMIUM, "--headless=new", "--no-sandbox", "--remote-debugging-port=0", "--no-first-run",
             "--disable-background-networking", f"--user-data-dir={self.folder.name}", *drawing, "about:blank"],
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True)
        atexit.register(self.stop)
        address = next(found[0] for line in self.process.stderr if (found := re.search(r"ws://\S+", line)))
        port = re.search(r":(\d+)/", address)[1]
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/json") as tabs:
            tab = next(t for t in json.load(tabs) if t["type"] == "page")
        self.loop = asyncio.new_event_loop()
        self.socket = self.loop.run_until_complete(connected(tab["webSocketDebuggerUrl"]))
        self.number, self.errors, self.requests = 0, [], []
        for domain in ["Runtime", "Log", "Page", "Network"]:
            self.call(f"{domain}.enable")
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1,
                  mobile=False)
        self.call("Emulation.setEmulatedMedia", media="", features=[
            {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])

    def call(self, method, **parameters):
        return self.loop.run_until_complete(self._call(method, parameters))

    async def _call(self, method, parameters):
        self.number += 1
        await self.socket.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while True:
            answer = json.loads(await self.socket.recv())
            if answer.get("id") == self.number:
                return answer.get("result", answer)
            self._note(answer)

    def _note(self, event):
        name, said = event.get("method"), event.get("params", {})
        if name == "Network.requestWillBeSent":
            self.requests.append(said["request"]["url"][:200])
        if name == "Runtime.exceptionThrown" \
                or name == "Log.entryAdded" and said["entry"]["level"] in ["error", "warning"] \
                or name == "Runtime.consoleAPICalled" and said["type"] in ["error", "warning"]:
            self.errors.append(json.dumps(said)[:500])

    def evaluate(self, script):
        """The value of SCRIPT, which may be a promise; raises what it throws."""
        answer = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(json.dumps(answer["exceptionDetails"])[:2000])
        return answer["result"].get("value")

    def open(self, path, mark=""):
        """Opens a page of a run; returns the seconds until its first picture."""
        begin = time.monotonic()
        self.call("Page.navigate", url=f"file://{os.path.abspath(path)}{mark}")
        while time.monotonic() < begin + 120:
            if self.evaluate("document.documentElement?.dataset.ready"
                             " || document.getElementById('missing')?.textContent"):
                return time.monotonic() - begin
            time.sleep(0.02)
        raise RuntimeError("the page does not get ready")

    def key(self, key):
        """Presses KEY where the focus is."""
        text = {"text": key} if len(key) == 1 else {}
        for kind in ["keyDown", "keyUp"]:
            self.call("Input.dispatchKeyEvent", type=kind, key=key, **(text if kind == "keyDown" else {}))

    def click(self, x, y):
        for kind in ["mousePressed", "mouseReleased"]:
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))

    def processor_time(self):
        """Seconds of all of its processes so far."""
        total, ticks = 0, os.sysconf("SC_CLK_TCK")
        for name in os.listdir("/proc"):
            try:
                with open(f"/proc/{name}/stat") as file:
                    words = file.read().rsplit(")", 1)[1].split()
                if int(words[3]) == self.process.pid:  # of its session
                    total += (int(words[11]) + int(words[12])) / ticks
            except (OSError, IndexError):
                continue
        return total

    def stop(self):
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGTERM)
            self.process.wait()
        self.process.stderr.close()

    def close(self):
        self.loop.run_until_complete(self.socket.close())
        self.loop.close()
        self.stop()
        self.folder.cleanup()
