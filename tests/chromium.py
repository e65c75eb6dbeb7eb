"""A real browser without a window, told what to do over a pipe in the words of Chrome's DevTools protocol: no package is needed."""

import base64
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

#: the browser to take; where it is set, tests that need one fail without it
VARIABLE = "DILATEDEM_CHROMIUM"
NAMES = ("chromium", "chromium-browser", "google-chrome")
#: s that the browser has to answer
PATIENCE = 120.0

#: the pipe's two ends must be files 3 and 4 of the browser
_START = "import os, sys; r, w = map(int, sys.argv[1:3]); os.dup2(r, 3); os.dup2(w, 4); os.execvp(sys.argv[3], sys.argv[3:])"
#: code and number of keys
_KEYS = {
    "+": ("Equal", 187), "-": ("Minus", 189), "ArrowLeft": ("ArrowLeft", 37), "ArrowRight": ("ArrowRight", 39),
    "Home": ("Home", 36),
}  # fmt: skip


def find() -> str | None:
    """The browser's command, None where there is none."""
    return os.environ.get(VARIABLE) or next(filter(None, map(shutil.which, NAMES)), None)


class Page:
    """One page in a browser of its own."""

    def __init__(self, command: str):
        self._folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        theirs_in, ours_out = (_apart(end) for end in os.pipe())
        ours_in, theirs_out = (_apart(end) for end in os.pipe())
        options = [
            "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run", "--hide-scrollbars",
            "--remote-debugging-pipe", f"--user-data-dir={self._folder.name}", "about:blank",
        ]  # fmt: skip
        start = [sys.executable, "-c", _START, str(theirs_in), str(theirs_out), command, *options]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        self._process = subprocess.Popen(start, pass_fds=(theirs_in, theirs_out), **quiet)
        os.close(theirs_in)
        os.close(theirs_out)
        self._out, self._in, self._rest = ours_out, ours_in, b""
        self._last, self._session = 0, None
        self._events: list[dict] = []
        targets = self.call("Target.getTargets")["targetInfos"]
        target = next(target["targetId"] for target in targets if target["type"] == "page")
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def __enter__(self) -> "Page":
        return self

    def __exit__(self, *fault) -> None:
        self._process.terminate()
        self._process.wait(timeout=PATIENCE)
        os.close(self._out)
        os.close(self._in)
        self._folder.cleanup()

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """The answer to one command of the protocol."""
        self._last += 1
        message = {"id": self._last, "method": method, "params": parameters}
        message |= {"sessionId": self._session} if self._session else {}
        rest = json.dumps(message).encode() + b"\0"
        while rest:
            rest = rest[os.write(self._out, rest) :]
        while True:
            answer = self._read()
            if answer.get("id") == self._last:
                assert "error" not in answer, answer["error"]
                return answer["result"]
            self._events.append(answer)

    def _read(self) -> dict[str, Any]:
        while b"\0" not in self._rest:
            part = os.read(self._in, 1 << 20)
            assert part, "the browser has ended"
            self._rest += part
        message, _, self._rest = self._rest.partition(b"\0")
        return json.loads(message)

    def open(self, file: Path, *, width: int = 1200, height: int = 900, script: bool = True) -> None:
        """Show a file, as wide as a screen of so many pixels, with or without scripts."""
        self._events.clear()
        phone = width < 600
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=phone)
        self.call("Emulation.setTouchEmulationEnabled", enabled=phone)
        self.call("Emulation.setScriptExecutionDisabled", value=not script)
        self.call("Page.navigate", url=file.resolve().as_uri())
        self.wait_for("document.readyState === 'complete'")

    def wait_for(self, condition: str) -> None:
        """Until an expression is true."""
        until = time.monotonic() + PATIENCE
        while not self.value(condition):
            assert time.monotonic() < until, condition
            time.sleep(0.05)

    def value(self, expression: str) -> Any:
        """What an expression of JavaScript gives."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def complaints(self) -> list[str]:
        """All that the page wrote to the console, the faults of its scripts, what the browser had to say."""
        self.value("0")
        told = {"Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded"}
        return [json.dumps(event["params"])[:300] for event in self._events if event.get("method") in told]

    def asked_for(self) -> list[str]:
        """Addresses that the page loaded, its own among them; not what stands in the page itself."""
        self.value("0")
        sent = [event["params"] for event in self._events if event.get("method") == "Network.requestWillBeSent"]
        return [asked["request"]["url"] for asked in sent if not asked["request"]["url"].startswith("data:")]

    def place(self, selector: str) -> tuple[float, float, float, float]:
        """Left, top, width and height [px] of an element in the window, into which it is scrolled."""
        found = f"document.querySelector({json.dumps(selector)})"
        self.value(f"{found}.scrollIntoView({{block: 'center'}})")
        box = self.value(f"(() => {{ const b = {found}.getBoundingClientRect(); return [b.left, b.top, b.width, b.height]; }})()")
        return tuple(box)

    def wheel(self, x: float, y: float, turns: float) -> None:
        self.call("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=turns)

    def drag(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        """With the left button of the mouse."""
        held = {"button": "left", "clickCount": 1}
        for kind, (x, y) in (("mouseMoved", start), ("mousePressed", start), ("mouseMoved", end), ("mouseReleased", end)):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **(held if kind != "mouseMoved" else {"buttons": 1}))

    def touch(self, *steps: list[tuple[float, float]]) -> None:
        """Fingers at these points, then at the next, then lifted."""
        for kind, points in zip(("touchStart", *["touchMove"] * (len(steps) - 1)), steps, strict=True):
            places = [{"x": x, "y": y, "id": finger} for finger, (x, y) in enumerate(points)]
            self.call("Input.dispatchTouchEvent", type=kind, touchPoints=places)
        self.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    def press(self, key: str) -> None:
        code, number = _KEYS[key]
        stroke = {"key": key, "code": code, "windowsVirtualKeyCode": number} | ({"text": key} if len(key) == 1 else {})
        self.call("Input.dispatchKeyEvent", type="keyDown", **stroke)
        self.call("Input.dispatchKeyEvent", type="keyUp", **(stroke | {"text": ""}))

    def pdf(self, width: float, height: float) -> bytes:
        """The page on paper of this size [mm], with what its style says of margins."""
        inch = 25.4
        return base64.b64decode(self.call("Page.printToPDF", paperWidth=width / inch, paperHeight=height / inch)["data"])

    def picture(self) -> bytes:
        """What the window shows, PNG."""
        return base64.b64decode(self.call("Page.captureScreenshot")["data"])


def _apart(file: int) -> int:
    """The same file under a number above those that the browser wants for its own."""
    import fcntl

    other = fcntl.fcntl(file, fcntl.F_DUPFD_CLOEXEC, 10)
    os.close(file)
    return other
