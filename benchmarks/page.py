"""The page of the manager in Chromium without a graphics card: frames that are really shown, and the first picture.

    python benchmarks/page.py [PROCESSES …]

A network of so many processes, of which 50 change twice a second, is panned and zoomed for some seconds at three
zooms. `shown` are the frames that Chromium's compositor showed in a second (its trace, `Display::DrawAndSwap`), less
than what the page draws. It counts only if the view moved, and something was under it. `first` is the time from
the navigation to the first picture with nodes, the fastest of three.
"""

from __future__ import annotations

import asyncio
import json
import os
import random
import shutil
import sys
import tempfile
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import rcyaml_manager
import uvicorn
from playwright.async_api import Browser, Page, async_playwright

from robocomp_yaml.manager.access import AccessRules
from robocomp_yaml.manager.app import application
from robocomp_yaml.manager.events import STATES
from robocomp_yaml.manager.managed import ManagedDeployment
from robocomp_yaml.manager.watching import Watcher

GOALS = {30: (30, 1.0), 500: (30, 3.0), 2000: (15, 0.0)}
CHANGED, SECONDS, MOVES = 50, 4.0, 60
KINDS = (
    "camera", "lidar", "motors", "planner", "mapper", "speech", "grid", "arm", "gripper", "imu", "battery", "joystick",
    "localiser", "tracker", "detector", "safety", "dialogue", "emotions", "faces", "recorder",
)  # fmt: skip
TOKEN = "page"


def fleet(folder: Path, size: int) -> Path:
    """A deployment of `size` programs in groups of 25 on hosts of 100; most use others of their group."""
    pick = random.Random(7)
    hosts = max(1, size // 100)
    lines = ["deployment: Fleet", "hosts:", *(f"  h{number}: 10.0.0.{number + 2}" for number in range(hosts))]
    lines.append("components:")
    names = [f"{KINDS[n % len(KINDS)]}{n // len(KINDS) or ''}" for n in range(size)]
    groups: dict[str, list[str]] = {}
    for number, name in enumerate(names):
        group, host = number // 25, number * hosts // size
        groups.setdefault(f"g{group}", []).append(name)
        near = [other for other in range(group * 25, number) if pick.random() < 0.07]
        far = [pick.randrange(number)] if number and pick.random() < 0.3 else []
        after = ", ".join(names[other] for other in dict.fromkeys((*near[:3], *far)))
        interface = KINDS[number % len(KINDS)].capitalize()
        lines.append(
            f"  {name}: {{program: sleep, args: ['600'], host: h{host}, after: [{after}], "
            f"endpoints: {{{interface}: tcp -p {20000 + number}}}}}"
        )
    lines.append("groups:")
    lines += [f"  {name}: {{components: [{', '.join(members)}]}}" for name, members in groups.items()]
    folder.mkdir(parents=True)
    (folder / "rcyaml.yaml").write_text("{}\n")
    document = folder / "fleet.ddsl.yaml"
    document.write_text("\n".join(lines) + "\n")
    return document


class QuietWatcher(Watcher):
    """States that are made up: no process runs."""

    async def run(self) -> None:
        pick, number = random.Random(3), 0
        for name in self.states:
            self._set(name, "ready")
        while True:
            await asyncio.sleep(0.5)
            number += 1
            changed = pick.sample(sorted(self.states), min(CHANGED, len(self.states)))
            for name in changed:
                self._set(name, "ready" if pick.random() < 0.9 else "failed")
            found = [self.states[name] for name in changed]
            self.events.send(STATES, {"all": False, "processes": found, "gone": [], "problem": ""})

    def _set(self, name: str, words: str) -> None:
        is_ready = words == "ready"
        self.states[name] = {**self.states[name], "words": words, "ready": is_ready, "down": not is_ready, "pid": 1000}


def serve(document: Path) -> tuple[uvicorn.Server, int]:
    watcher = QuietWatcher(ManagedDeployment(str(document)))
    app = application({"Fleet": watcher}, AccessRules(TOKEN), rcyaml_manager.files())
    server = uvicorn.Server(uvicorn.Config(app, port=0, log_level="error", ws="none", timeout_graceful_shutdown=1))
    threading.Thread(target=server.run, daemon=True).start()
    while not server.started:
        time.sleep(0.02)
    return server, server.servers[0].sockets[0].getsockname()[1]


async def opened(browser: Browser, port: int) -> tuple[Page, float]:
    """The page, and the seconds to its first picture, as the browser measures them."""
    page = await browser.new_page(viewport={"width": 1500, "height": 850})
    await page.add_init_script(
        "const wait = () => { if (window.scene?.drawn && model.graph?.nodes.length) requestAnimationFrame(() =>"
        "{ window.pictured = performance.now() }); else requestAnimationFrame(wait) }; requestAnimationFrame(wait)"
    )
    await page.goto(f"http://127.0.0.1:{port}/?token={TOKEN}")
    while not (found := await page.evaluate("window.pictured ?? 0")):
        await asyncio.sleep(0.05)
    return page, found / 1000


async def shown(browser: Browser, page: Page, zoom: float) -> float:
    """The frames a second that were shown while the view was panned and zoomed around the middle."""
    width, height = 1500, 850
    await page.evaluate(
        "(zoom) => { scene.fit(); const c = document.getElementById('picture');"
        "const m = model.graph.nodes[model.graph.nodes.length >> 1];"
        "if (zoom) { scene.zoomAt(zoom / scene.zoom, 0, 0);"
        "scene.pan(c.clientWidth / 2 - scene.x - m.x * zoom, c.clientHeight / 2 - scene.y - m.y * zoom) } }", zoom,
    )  # fmt: skip
    await asyncio.sleep(0.3)
    await page.mouse.move(width / 2, height - 20)
    session = await page.context.new_cdp_session(page)
    before = await page.evaluate("[scene.x, scene.y, scene.drawn]")
    await browser.start_tracing(page=page, categories=["viz", "-*"])
    begin, sent = time.monotonic(), set[asyncio.Task[Any]]()

    def send(kind: str, x: float, y: float, **more: Any) -> None:
        """Without waiting for the answer, which would limit the number of moves."""
        task = asyncio.create_task(session.send(
            "Input.dispatchMouseEvent", {"type": kind, "x": x, "y": y, "pointerType": "mouse", **more}
        ))  # fmt: skip
        sent.add(task)
        task.add_done_callback(sent.discard)

    places, step = set(), 0
    corner = await page.evaluate(  # where no node is, which would be dragged instead
        "(() => { const p = document.getElementById('picture').getBoundingClientRect();"
        "for (let y = p.height - 20; y > 300; y -= 7) for (let x = p.width - 60; x > 500; x -= 11)"
        "{ const hit = scene.hit(x, y); if (!hit || hit.name) return [p.x + x, p.y + y] } })()"
    )
    send("mousePressed", *corner, button="left", buttons=1, clickCount=1)
    while (now := time.monotonic() - begin) < SECONDS:
        step += 1
        if step % 20 == 0:
            send("mouseWheel", width / 2, height / 2, deltaX=0, deltaY=60 if step % 40 else -60)
        offset = 180 * (1 - abs((now % 2) - 1))
        send("mouseMoved", corner[0] - offset * 2, corner[1] - offset, button="left", buttons=1)
        if step % 30 == 0:
            places.add(tuple(await page.evaluate("[Math.round(scene.x), Math.round(scene.y)]")))
        await asyncio.sleep(1 / MOVES)
    send("mouseReleased", *corner, button="left", buttons=0, clickCount=1)
    seconds = time.monotonic() - begin
    trace = json.loads(await browser.stop_tracing())
    with suppress(Exception):
        await asyncio.wait_for(asyncio.gather(*sent), 5)
    drawn = (await page.evaluate("scene.drawn")) - before[2]
    seen = await page.evaluate(
        "(() => { const c = document.getElementById('picture'), [l, t] = scene.point(0, 0);"
        "const [r, b] = scene.point(c.clientWidth, c.clientHeight), isIn = (n) => n.x < r && n.y < b"
        "&& n.x + n.width > l && n.y + n.height > t; return model.graph.nodes.filter(isIn).length })()"
    )
    assert len(places) > 1, f"the view did not move: {places}"
    assert seen > 3, "nothing is under the view"
    assert drawn > 10
    frames = [one for one in trace["traceEvents"] if one["name"] == "Display::DrawAndSwap" and one["ph"] in "XB"]
    return len(frames) / seconds


async def main(sizes: list[int]) -> None:
    chromium = shutil.which("chromium")
    async with async_playwright() as playwright:
        browser = await playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox", "--disable-gpu"])
        for size in sizes:
            with tempfile.TemporaryDirectory() as folder:
                server, port = serve(fleet(Path(folder) / "fleet", size))
                times = []
                for _ in range(3):
                    page, first = await opened(browser, port)
                    times.append(first)
                    if len(times) < 3:
                        await page.close()
                goal, limit = GOALS.get(size, (30, 3.0))
                print(f"{size:5} processes  first {min(times):.2f} s (goal {limit or '–'})", end="  shown", flush=True)
                for name, zoom in (("all", 0.0), ("names", 0.45), ("texts", 1.0)):
                    found = await shown(browser, page, zoom)
                    print(f"  {name} {found:4.1f} ({found / goal:.1f} of the goal)", end="", flush=True)
                print(f"  load {os.getloadavg()[0]:.1f}")
                await page.close()
                server.should_exit = True
        await browser.close()


if __name__ == "__main__":
    asyncio.run(main([int(word) for word in sys.argv[1:]] or [30, 500, 2000]))
