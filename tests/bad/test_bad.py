"""Broken input: every case gives exactly its golden diagnostics, and no traceback."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

CASES = sorted(Path(__file__).parent.glob("*.case"))
_HEADING = re.compile(r"^--- (.*)\n", re.MULTILINE)


@dataclass
class Case:
    command: list[str]
    files: dict[str, str | bytes | None]
    says: str | None


def load(path: Path) -> Case:
    """The sections of a case file: `--- rcyaml COMMAND`, a file each, and `--- says`."""
    _, *parts = _HEADING.split(path.read_text(encoding="utf-8"))
    sections = dict(zip(parts[::2], parts[1::2], strict=True))
    says = sections.pop("says", None)
    command = next(name for name in sections if name.startswith("rcyaml "))
    del sections[command]
    files: dict[str, str | bytes | None] = {}
    for name, text in sections.items():
        if name.endswith(" (escaped)"):
            raw = text.rstrip("\n").encode("latin-1").decode("unicode_escape").encode("latin-1")
            files[name.removesuffix(" (escaped)")] = raw + b"\n"
        else:
            files[name] = text.rstrip("\n") if text.startswith("-> ") else text
    return Case(shlex.split(command)[1:], files, says)


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_case(path: Path, rcyaml: Callable[..., Result], tmp_path: Path, request: pytest.FixtureRequest) -> None:
    case = load(path)
    write_tree(tmp_path, case.files)
    before = {name: (tmp_path / name).read_bytes() for name in case.files if (tmp_path / name).is_file()}
    result = rcyaml("--color", "never", *case.command)
    says = f"exit {result.exit_code}\n{result.output}"
    if request.config.getoption("--update-golden"):
        head = path.read_text(encoding="utf-8").partition("--- says\n")[0]
        path.write_text(f"{head}--- says\n{says}", encoding="utf-8")
        return
    assert case.says is not None, "run pytest --update-golden, and read what it says"
    assert says == case.says
    assert {name: (tmp_path / name).read_bytes() for name in before} == before, "what was there is as it was"


def test_there_are_more_than_a_hundred() -> None:
    assert len(CASES) > 100
