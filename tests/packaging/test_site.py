"""`make docs` builds the documentation as a site: with pip alone, and not if a link or an anchor is broken."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
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
    with open(checkout / "docs" / "cli.md", "a", encoding="utf-8") as text:
        text.write("\n[nowhere](idsl.md#no-such-heading)\n")
    code, said = make(checkout)
    assert code != 0 and "no-such-heading" in said
