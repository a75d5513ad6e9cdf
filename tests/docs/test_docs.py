"""Every command that the documentation shows is run, and prints what the page says.

In a page, a code block after `<!-- file: PATH -->` is a file (an existing one is replaced), and a `console` block is a
session: lines that start with `$ ` are commands, the others what they print. A page's blocks are run from top to
bottom in one empty folder. `<!-- in: FOLDER -->` starts from a copy of a folder of the project. A line `…` stands for
any lines, and `…` in a line for any text in it. `<!-- needs: Ice, mcap -->` is in a page that is skipped without
these modules. `pytest tests/docs --update-golden` writes what the commands print.
"""

from __future__ import annotations

import fcntl
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from conftest import ROOT

PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
_BLOCK = re.compile(
    r"(?:<!-- (?P<mark>file|in): (?P<name>\S+) -->\n)?```(?P<kind>\w+)\n(?P<body>.*?)^```$|<!-- in: (?P<folder>\S+) -->",
    re.MULTILINE | re.DOTALL,
)


@dataclass
class Session:
    """A command with the output that the page shows, and the place of that output in the page."""

    command: str
    shown: str
    start: int
    end: int


def sessions(body: str, offset: int) -> Iterator[Session]:
    position = 0
    current: Session | None = None
    for line in body.splitlines(keepends=True):
        position += len(line)
        if line.startswith("$ "):
            if current:
                yield current
            current = Session(line[2:].rstrip("\n"), "", offset + position, offset + position)
        elif current:
            current.shown += line
            current.end = offset + position
    if current:
        yield current


def run(command: str, folder: Path) -> str:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    plain = {key: value for key, value in os.environ.items() if not key.startswith("RCYAML")}
    done = subprocess.run(
        ["bash", "-c", command], cwd=folder, env={**plain, "PATH": path}, text=True, timeout=60,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    return done.stdout


def matches(shown: str, printed: str) -> bool:
    parts = [re.escape(part).replace("…", ".*") for part in re.split(r"^…\n", shown, flags=re.MULTILINE)]
    return re.fullmatch("(?:.*\n)*?".join(parts), printed) is not None


@pytest.fixture
def turn(page: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Pages that start networks wait for each other: entries of the same name have the same ports."""
    if "$ rcyaml deploy up" not in page.read_text(encoding="utf-8"):
        yield
        return
    with open(tmp_path_factory.getbasetemp().parent / "networks.lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


@pytest.mark.usefixtures("turn")
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_page(page: Path, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    text = page.read_text(encoding="utf-8")
    for needed in re.findall(r"\w+", (re.findall("<!-- needs: (.*) -->", text) or [""])[0]):
        pytest.importorskip(
            needed, reason=f"the page needs {needed} (Debian: python3-zeroc-ice; pip install rcyaml[record])"
        )
    replaced: list[tuple[Session, str]] = []
    for block in _BLOCK.finditer(text):
        folder = block["folder"] or (block["name"] if block["mark"] == "in" else None)
        if folder:
            shutil.copytree(ROOT / folder, tmp_path, dirs_exist_ok=True)
        if block["mark"] == "file":
            target = tmp_path / block["name"]
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(block["body"], encoding="utf-8")
        if block["kind"] == "console":
            for session in sessions(block["body"], block.start("body")):
                printed = run(session.command, tmp_path)
                if not matches(session.shown, printed):
                    replaced.append((session, printed))
    if request.config.getoption("--update-golden"):
        for session, printed in reversed(replaced):
            text = text[: session.start] + printed + text[session.end :]
        page.write_text(text, encoding="utf-8")
        return
    assert [(s.command, s.shown) for s, _ in replaced] == [(s.command, printed) for s, printed in replaced]


def test_the_pages_show_commands() -> None:
    assert sum(page.read_text(encoding="utf-8").count("\n$ ") for page in PAGES) > 20


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    for link in re.findall(r"\]\((?!https?:|#|mailto:)([^)#\s]+)", page.read_text(encoding="utf-8")):
        assert (page.parent / link).exists(), link


_FENCE = re.compile(r"^(`{3,}).*?^\1$", re.MULTILINE | re.DOTALL)
_NAMED = re.compile(r"`([a-z_]+/[a-z0-9_*/]*[a-z0-9_*])(\.[a-z]+|\.[A-Z]+|/)?`")
FOLDERS = {
    **dict.fromkeys(("benchmarks", "docs", "examples", "migrate", "schemas", "templates", "tests", "tools"), ROOT),
    **{path.parent.name: path.parents[1] for path in (ROOT / "robocomp_yaml").glob("*/__init__.py")},
}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_paths_of_the_project_exist(page: Path) -> None:
    """A path in a folder of the project or of the package: a folder, a file, a module, or a name in a module."""
    for path, suffix in _NAMED.findall(_FENCE.sub("", page.read_text(encoding="utf-8"))):
        if home := FOLDERS.get(path.partition("/")[0]):
            suffix = ".py" if suffix.isupper() else suffix.strip("/")
            assert any(home.glob(path + suffix)) or any(home.glob(f"{path}.py")), path + suffix


def test_pages_name_paths_of_the_project() -> None:
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    assert len({path for path, _ in _NAMED.findall(text) if path.partition("/")[0] in FOLDERS}) > 20


def test_the_example_is_the_tutorials() -> None:
    """`examples/patrol/` is what the first page of the tutorial ends with."""
    text = (ROOT / "docs" / "tutorial" / "README.md").read_text(encoding="utf-8")
    files = {block["name"]: block["body"] for block in _BLOCK.finditer(text) if block["mark"] == "file"}
    assert len(files) == 3
    for name, body in files.items():
        assert (ROOT / "examples" / "patrol" / name).read_text(encoding="utf-8") == body, name


def test_pictures_are_small_and_shown() -> None:
    pictures = [path for path in (ROOT / "docs").rglob("*") if path.suffix in (".svg", ".png")]
    assert sum(path.stat().st_size for path in pictures) <= 5_000_000
    text = "".join(page.read_text(encoding="utf-8") for page in PAGES)
    assert [path.name for path in pictures if f"/{path.name})" not in text] == []


def test_the_picture_of_the_architecture_names_classes() -> None:
    text = (ROOT / "docs" / "pictures" / "architecture.svg").read_text(encoding="utf-8")
    named = set(re.findall(r'class="type">(\w+)<', text))
    code = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "robocomp_yaml").rglob("*.py"))
    assert {"Node", "Program", "Network"} <= named <= set(re.findall(r"^class (\w+)\b", code, re.MULTILINE))
