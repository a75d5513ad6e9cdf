"""Long and deep texts are read in a moment: a document may hold a megabyte, and what is quadratic in it takes hours."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pytest

from robocomp_yaml.emit.specific.reading import read
from robocomp_yaml.source import tree, xml
from robocomp_yaml.source.ice_proxy import proxy_at


@pytest.fixture(autouse=True)
def in_a_moment() -> Iterator[None]:
    begin = time.process_time()
    yield
    assert time.process_time() - begin < 5


SIZE = 100_000


@pytest.mark.parametrize(
    "text", ['s:tcp -h "' + ":" * SIZE, "\\/" * SIZE, "\\" * SIZE, "s:" + '"a"' * SIZE + ":", '"' + '\\"' * SIZE],
    ids=["colons", "escaped", "backslashes", "quotes", "escaped quotes"],
)  # fmt: skip
def test_proxies(text: str) -> None:
    proxy_at(text)


def test_one_long_line_of_xml() -> None:
    elements = xml.MAX_ELEMENTS - 1
    text = "<a>" + "".join(f'<b c="{"x" * 90}" d="{n}"/>' for n in range(elements)) + "</a>"
    root, diagnostics = xml.parse("m.scxml", text)
    assert root is not None and len(root.children) == elements and not diagnostics


@pytest.mark.parametrize(("opening", "closing"), [("[", "]"), ("{a: ", "}"), ("- ", "")])
def test_deep_nesting_is_refused(opening: str, closing: str) -> None:
    depth = 300_000
    root, diagnostics = tree.parse("x.yaml", opening * depth + "1" + closing * depth)
    assert root is None and [one.code for one in diagnostics] == ["RC0106"]


DEEP = "namespace a { class SpecificWorker { void f() { " * 2000 + "".join(f"{' ' * n}if x:\n" for n in range(300))


@pytest.mark.parametrize("path", ["a.py", "a.h", "a.cpp"])
def test_deep_code(path: str) -> None:
    found = read(path, DEEP)
    assert found is not None and "".join(found.lines) == DEEP
