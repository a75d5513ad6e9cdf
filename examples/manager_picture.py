"""The manager's picture of a running network: in a browser where there is a display, else in a file."""

from __future__ import annotations

import base64
import importlib.util
import json
import os
import shutil
import signal
import subprocess
import tempfile
import threading
import time
from contextlib import suppress
from typing import IO, Any
from urllib.parse import urlsplit

from session import ENVIRONMENT, RCYAML, Session, comment, say

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
LIBRARIES = ("starlette", "uvicorn", "rcyaml_manager")
PICTURE, DRAWING = "manager.png", "network.svg"
PATIENCE = 40  # seconds for the browser


def show(session: Session, network: str) -> None:
    """Shows the picture until Ctrl-C, or writes it."""
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if not all(importlib.util.find_spec(name) for name in LIBRARIES):
        comment("The page of the manager is not built here; this is its network as a drawing.")
    elif os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"):
        comment("The manager: the same network in a browser, live. Ctrl-C ends it, and stops the network.")
        try:
            session.run("rcyaml", "manager", network)
        except (KeyboardInterrupt, subprocess.CalledProcessError):
            say("")
        return
    elif browser is None:
        comment("The manager would show the network in a browser, and there is none here; this is it as a drawing.")
    elif photographed(session, network, browser):
        comment(f"The manager shows the same network in a browser, live: `rcyaml manager {network}`. There is no")
        say(f"# display here, so that its picture is in {session.folder.name}/{PICTURE}.")
        return
    else:
        comment("The browser of this machine takes no picture of the manager; this is the network as a drawing.")
    session.run("rcyaml", "graph", network, "--as", "svg", "-o", DRAWING)


def photographed(session: Session, network: str, browser: str) -> bool:
    """Writes a picture of the manager's page. The manager that is photographed may change nothing."""
    path = session.folder / PICTURE
    path.unlink(missing_ok=True)
    command = [*RCYAML, "manager", "--read-only", "--no-browser", network]
    with subprocess.Popen(
        command, cwd=session.folder, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as manager:  # fmt: skip
        try:
            address = next((word for line in manager.stdout or () for word in line.split() if _is_address(word)), "")
            if address:
                with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as own:
                    path.write_bytes(_photograph(browser, own, address))
        except (OSError, ValueError, LookupError):
            path.unlink(missing_ok=True)
        finally:
            manager.terminate()
            with suppress(subprocess.TimeoutExpired):
                manager.wait(PATIENCE)
            manager.kill()
    return path.is_file()


def _photograph(browser: str, own: str, address: str) -> bytes:
    """The page as PNG. The browser is steered by its DevTools protocol over two pipes, which needs no library, and the
    address with its token is in no list of processes. Raises OSError, ValueError and LookupError."""
    to_browser, from_us = os.pipe()
    from_browser, to_us = os.pipe()
    words = [browser, "--headless", "--disable-gpu", "--hide-scrollbars", "--no-first-run", "--remote-debugging-pipe",
             f"--user-data-dir={own}", *(["--no-sandbox"] if os.geteuid() == 0 else [])]  # fmt: skip
    script = f'exec "$@" 3<&{to_browser} 4>&{to_us}'
    running = subprocess.Popen(
        ["sh", "-c", script, "sh", *words], pass_fds=(to_browser, to_us), stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
    )  # fmt: skip
    limit = threading.Timer(PATIENCE, os.killpg, (running.pid, signal.SIGKILL))
    limit.start()
    os.close(to_browser)
    os.close(to_us)
    try:
        with open(from_us, "wb", 0) as sending, open(from_browser, "rb") as receiving:
            page = _Page(sending, receiving)
            size = {"width": 1280, "height": 720, "deviceScaleFactor": 1.5, "mobile": False}
            page.do("Emulation.setDeviceMetricsOverride", **size)
            page.do("Page.navigate", url=address)
            until = time.monotonic() + PATIENCE / 2
            while page.number_of_processes() == 0 and time.monotonic() < until:
                time.sleep(0.2)
            time.sleep(1.5)  # the states come after the picture
            return base64.b64decode(page.do("Page.captureScreenshot", format="png")["data"])
    finally:
        limit.cancel()
        with suppress(ProcessLookupError):
            os.killpg(running.pid, signal.SIGKILL)
        running.wait()


class _Page:
    """A page of a browser (https://chromedevtools.github.io/devtools-protocol/). Messages end with a zero byte."""

    def __init__(self, sending: IO[bytes], receiving: IO[bytes]) -> None:
        self._sending, self._receiving, self._number, self._session = sending, receiving, 0, ""
        target = self.do("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.do("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]

    def do(self, method: str, **parameters: Any) -> dict[str, Any]:
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        message |= {"sessionId": self._session} if self._session else {}
        self._sending.write(json.dumps(message).encode() + b"\0")
        while True:
            answer: dict[str, Any] = json.loads(self._message())
            if answer.get("id") == self._number:
                result: dict[str, Any] = answer["result"]
                return result

    def _message(self) -> bytes:
        made = bytearray()
        while (byte := self._receiving.read(1)) != b"\0":
            if not byte:
                raise OSError("the browser has ended")
            made += byte
        return bytes(made)

    def number_of_processes(self) -> int:
        count = "document.querySelectorAll('[role=treeitem]').length"
        return int(self.do("Runtime.evaluate", expression=count, returnByValue=True)["result"].get("value") or 0)


def _is_address(word: str) -> bool:
    return urlsplit(word).scheme == "http"
