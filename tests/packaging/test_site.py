"""`make docs` builds the documentation as a site: with pip alone, and not if a link or an anchor is broken."""

from __future__ import annotations

import http.server
import json
import os
import shutil
import subprocess
import threading
from functools import partial
from pathlib import Path

import pytest

from conftest import ROOT

pytestmark = pytest.mark.slow

NEEDED = (
    "docs", "examples", "experiments", "migrate", "robocomp_yaml", "schemas", "templates", "tools",
    "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE", "Makefile", "README.md", "SECURITY.md", "mkdocs.yml", "pyproject.toml",
)  # fmt: skip


def make(checkout: Path) -> tuple[int, str]:
    plain = {key: value for key, value in os.environ.items() if not key.startswith(("PYTHON", "MAKE", "VENV"))}
    done = subprocess.run(["make", "docs"], cwd=checkout, env=plain, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def look_at(site: Path) -> None:
    """A browser asks no other server, and the button of a session copies its commands."""
    sync = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    handler = partial(http.server.SimpleHTTPRequestHandler, directory=str(site))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server, sync.sync_playwright() as browsers:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        home = f"http://127.0.0.1:{server.server_port}/"
        browser = browsers.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        context = browser.new_context(permissions=["clipboard-read", "clipboard-write"])
        page = context.new_page()
        asked: list[str] = []
        page.on("request", lambda request: asked.append(request.url))
        page.goto(f"{home}tutorial/")
        page.get_by_role("button", name="Copy to clipboard").nth(2).click()
        page.get_by_text("Copied to clipboard").wait_for()
        assert page.evaluate("navigator.clipboard.readText()") == "rcyaml new interface Base"
        browser.close()
        server.shutdown()
    assert asked and all(one.startswith(home) for one in asked)


def test_it_is_built_and_checked(tmp_path: Path) -> None:
    checkout = tmp_path / "checkout"
    checkout.mkdir()
    for name in NEEDED:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, checkout / name, ignore=shutil.ignore_patterns("__pycache__", ".rcyaml"))
        else:
            shutil.copy(ROOT / name, checkout)
    code, said = make(checkout)
    assert code == 0, said
    site = checkout / "site"
    assert "Two components that talk" in (site / "tutorial" / "index.html").read_text(encoding="utf-8")
    found = json.loads((site / "search" / "search_index.json").read_text(encoding="utf-8"))["docs"]
    assert {"reference/commands/#rcyaml-deploy-up", "diagnostics/cdsl/#rc2003"} <= {one["location"] for one in found}
    page = (site / "index.html").read_text(encoding="utf-8")
    assert 'data-md-color-scheme="slate"' in page, "dark mode"
    assert "fonts.googleapis" not in page and 'src="http' not in page, "nothing is loaded from elsewhere"
    look_at(site)
    with open(checkout / "docs" / "cli.md", "a", encoding="utf-8") as text:
        text.write("\n[nowhere](idsl.md#no-such-heading)\n")
    code, said = make(checkout)
    assert code != 0 and "no-such-heading" in said
