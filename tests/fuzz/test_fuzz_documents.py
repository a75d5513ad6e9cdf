"""Documents of all kinds, changed at random: every command says what is wrong, at a place, and none stumbles."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from hypothesis import example, given
from hypothesis import strategies as st

from conftest import Tree
from documents_of_rows import DOCUMENTS
from fuzzing import as_bytes, changed, examples, run, standing_in, told
from robocomp_yaml.source.tree import parse
from robocomp_yaml.source.yaml_text import flow

GRAPHS = ("dot", "json", "mermaid", "svg", "text")
EXPORTS = ("icegrid", "rcmanager", "systemd", "compose")
JUNK = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5) | st.sampled_from((
        "..", "/etc/passwd", "Speech", "speech.cdsl.yaml", "{i}", "tcp -p 10001", "10 s", "a.b", "x-a", "", "\n", "\0", 10**30,
    )),
    lambda inner: st.lists(inner, max_size=2) | st.dictionaries(st.text(max_size=3), inner, max_size=2), max_leaves=3,
)  # fmt: skip


@st.composite
def changed_texts(draw: st.DrawFn) -> Tree:
    """A tree of which one document differs from a good one, or from one with one fault."""
    files = draw(st.sampled_from(DOCUMENTS))
    name = draw(st.sampled_from(sorted(name for name, text in files.items() if text is not None)))
    text = files[name]
    assert text is not None
    text = text.decode("utf-8", "replace") if isinstance(text, bytes) else text
    return {**files, name: as_bytes(draw(changed(text)))}


@st.composite
def _replaced(draw: st.DrawFn, data: Any) -> Any:
    """The same with something else in one place."""
    if isinstance(data, dict) and data and draw(st.integers(0, 4)):
        key = draw(st.sampled_from(list(data)))
        match draw(st.sampled_from(("in", "in", "in", "in", "remove", "rename", "add"))):
            case "in":
                return {**data, key: draw(_replaced(data[key]))}
            case "remove":
                return {name: value for name, value in data.items() if name != key}
            case "rename":
                to = draw(
                    st.text(max_size=4) | st.sampled_from(("x-a", "doc", "type", "{i}", "a-b", "é", "class", ".."))
                )
                return {to if name == key else name: value for name, value in data.items()}
        return {**data, draw(st.text(max_size=3)): draw(JUNK)}
    if isinstance(data, list) and data and draw(st.integers(0, 4)):
        at = draw(st.integers(0, len(data) - 1))
        return [*data[:at], draw(_replaced(data[at])), *data[at + draw(st.integers(0, 1)) :]]
    return draw(JUNK)


_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]")


@st.composite
def changed_trees(draw: st.DrawFn) -> Tree:
    """A tree of which one document has another value somewhere, or other keys."""
    files = draw(st.sampled_from(DOCUMENTS))
    name = draw(st.sampled_from(sorted(name for name in files if name.endswith(".yaml"))))
    text = files[name]
    is_text = isinstance(text, str) and not _CONTROL.search(text)  # otherwise it is refused before it is parsed
    root, _ = parse(name, str(text)) if is_text else (None, [])
    data = root.data if root is not None else {}
    for _ in range(draw(st.integers(1, 2))):
        data = draw(_replaced(data))
    return {**files, name: as_bytes(flow(data))}


def look(files: Tree, pick: int) -> None:
    """All that only looks at documents, and one of the commands that make something of them."""
    with standing_in(files) as folder:
        _, found = told("check", ".")
        is_right = not any(each["severity"] == "error" for each in found)
        for path in sorted(folder.rglob("*.yaml")):
            name = str(path.relative_to(folder))
            if name.endswith("config.yaml"):
                told("config", "check", name)
                for command in ("show", "export"):
                    run("config", command, name)
            elif name.endswith("ddsl.yaml"):
                run("graph", name, "--as", GRAPHS[pick % len(GRAPHS)])
                made = run("deploy", "export", name, "--as", EXPORTS[pick % len(EXPORTS)])
                assert made.exit_code != 2 or not is_right, made.output
                if b"hosts" not in Path(name).read_bytes():  # to plan is to ask the hosts
                    run("deploy", "plan", name)
        if pick % 3 == 0:
            _, of_compile = told("compile")
            codes = {each["code"] for each in of_compile if each["severity"] == "error"}
            assert not is_right or all(code.startswith("RC6") for code in codes), (codes, found)
            if not codes:
                assert "0 files written" in run("compile").output


# Each kept as it was found, or smaller.
@example({"c.cdsl.yaml": "\u2028component: C\nlanguage: python\nimports: [M]\nrequires: [M, M]\n"}, 0)
@example({"etc/config.yaml": b"extends: [robot.config.yaml]", "c.cdsl.yaml": "component: C\nlanguage: python\n",
          "etc/robot.config.yaml": "parameters: {}\n"}, 0)  # fmt: skip
@given(changed_texts(), st.integers(0, 59))
@examples(150)
def test_texts(files: Tree, pick: int) -> None:
    look(files, pick)


@given(changed_trees(), st.integers(0, 59))
@examples(150)
def test_trees(files: Tree, pick: int) -> None:
    look(files, pick)
