"""What the harnesses share: trees in folders of their own, rcyaml run in this process, and what must hold whatever the
documents say."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from click.testing import CliRunner, Result
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

from conftest import FUZZING, Tree, write_tree
from robocomp_yaml.cli import group


def examples(count: int, times: int = 10) -> settings:
    """So many examples as a part of all tests, and so many times as many when new ones are looked for."""
    return settings(
        max_examples=count * times if FUZZING else count, deadline=None, suppress_health_check=list(HealthCheck)
    )


@contextmanager
def standing_in(files: Tree) -> Iterator[Path]:
    """A new folder, always called alike, that holds these files and is the current one."""
    before = os.getcwd()
    outer = Path(tempfile.mkdtemp(prefix="fuzz-")).resolve()
    folder = outer / "robot"
    try:
        folder.mkdir()
        write_tree(folder, files)
        os.chdir(folder)
        yield folder
    finally:
        os.chdir(before)
        shutil.rmtree(outer, ignore_errors=True)


def run(*args: str) -> Result:
    """`rcyaml ARGS`: never a traceback, and an exit code that means something."""
    result = CliRunner().invoke(group, ["--color", "never", *args], prog_name="rcyaml")
    if result.exception and not isinstance(result.exception, SystemExit):
        raise result.exception
    assert result.exit_code in (0, 1, 2), (args, result.exit_code, result.output)
    return result


def told(*args: str) -> tuple[Result, list[dict[str, Any]]]:
    """The diagnostics of `rcyaml ARGS --format json`, each with a place that there is."""
    result = run(*args, "--format", "json")
    if result.exit_code == 2:
        return result, []
    found = json.loads(result.stdout)["diagnostics"]
    for diagnostic in found:
        for place in (diagnostic, *diagnostic["related"]):
            is_in_its_file(place)
    is_error = any(diagnostic["severity"] == "error" for diagnostic in found)
    assert result.exit_code == int(is_error), (args, result.exit_code, found)
    return result, found


def is_in_its_file(place: Mapping[str, Any]) -> None:
    start, end = (place["line"], place["column"]), (place["end_line"], place["end_column"])
    assert (1, 1) <= start <= end, place
    try:
        content = Path(place["file"]).read_bytes()
    except (OSError, ValueError):
        assert (start, end) == ((1, 1), (1, 1)), place
        return
    text = content.decode("utf-8", "replace").removeprefix("\ufeff")
    # a lone carriage return ends a line of YAML, and none of a legacy file
    ways = [text.replace("\r\n", "\n").replace("\r", "\n").split("\n"), text.split("\n")]
    for line, column in (start, end):
        assert any(line <= len(lines) and column <= len(lines[line - 1]) + 2 for lines in ways), (place, ways[0])


# Texts that differ a little from good ones.

PIECES = (
    "\n", " ", "  ", "\t", ":", ": ", "- ", "#", ",", "[", "]", "{", "}", '"', "'", "|", ">", "&a ", "*a", "!!str ", "!x ",
    "? ", "---\n", "...\n", "%YAML 1.1\n", "<<: ", "null", "~", "true", "no", "0", "-1", "1e999", "0x1F", "9" * 40, ".nan",
    "é", "\ufeff", "\u2028", "\x85", "\0", "\x1b[31m", "\u202e", "\U0001f916", "a" * 300, "..", "/", "\\", "${x}", "{i}",
    "{config}", "%s", "{{ x }}", "*/", "*", "\r\n", "\r", "\x7f", "\ud800",
)  # fmt: skip


@st.composite
def changed(draw: st.DrawFn, text: str, more: tuple[str, ...] = ()) -> str:
    """A text with up to three changes: a stretch taken away, doubled, moved or replaced by something hard."""
    for _ in range(draw(st.integers(1, 3))):
        start = draw(st.integers(0, len(text)))
        end = min(len(text), start + draw(st.sampled_from((0, 1, 1, 2, 5, 20))))
        lines = text.split("\n")
        match draw(st.sampled_from(("cut", "put", "put", "double", "line", "swap", "word"))):
            case "cut":
                text = text[:start] + text[end:]
            case "put":
                text = text[:start] + draw(st.sampled_from(PIECES + more) | st.text(max_size=3)) + text[end:]
            case "double":
                text = text[:end] + text[start:end] + text[end:]
            case "line":
                at = draw(st.integers(0, len(lines) - 1))
                text = "\n".join([*lines[:at], *lines[at + 1 :]])
            case "swap":
                at, to = (draw(st.integers(0, len(lines) - 1)) for _ in range(2))
                lines[at], lines[to] = lines[to], lines[at]
                text = "\n".join(lines)
            case _:
                words = text.split(" ")
                at, to = (draw(st.integers(0, len(words) - 1)) for _ in range(2))
                words[at] = words[to]
                text = " ".join(words)
    return text


def as_bytes(text: str) -> bytes:
    return text.encode("utf-8", "surrogatepass")


Draw = Callable[[st.SearchStrategy[Any]], Any]
