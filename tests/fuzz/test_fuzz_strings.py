"""Texts that mean something to another language, in every place where a document may have a text: each artefact has the
structure that it has with a harmless text, or the text is refused at its place."""

from __future__ import annotations

import functools
import json
import re
from collections.abc import Iterator
from typing import Any

from hypothesis import example, given
from hypothesis import strategies as st

from conftest import read_tree
from fuzzing import as_bytes, examples, run, standing_in, told
from hostile import STRINGS
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence, parse
from robocomp_yaml.source.yaml_text import flow
from robot import TREE
from skeletons import structure

Place = tuple[str, tuple[str | int, ...]]  # a document, and the steps to a text in it; "" at the end for a key
Texts = dict[Place, str]
FREE = "Free"
FORMS = {"graph": ("dot", "json", "mermaid", "svg", "text"), "export": ("icegrid", "rcmanager", "systemd", "compose")}


@functools.cache
def data() -> dict[str, Any]:
    found = {}
    for name, text in TREE.items():
        root, faults = parse(name, text)
        assert not faults, faults
        found[name] = root.data if root is not None and name.endswith(".yaml") else None
    return found


def leaves(node: Any, steps: tuple[str | int, ...] = ()) -> Iterator[tuple[tuple[str | int, ...], Any]]:
    if isinstance(node, dict):
        for key, value in node.items():
            yield (*steps, key, ""), key
            yield from leaves(value, (*steps, key))
    elif isinstance(node, list):
        for at, value in enumerate(node):
            yield from leaves(value, (*steps, at))
    elif isinstance(node, str):
        yield steps, node


@functools.cache
def places(*, free: bool) -> list[Place]:
    """Where a text stands: all of them, or those of which the documents say that they may be any."""
    every = [((name, steps), text) for name, root in data().items() for steps, text in leaves(root)]
    return [place for place, text in every if not free or str(text).startswith(FREE)]


def documents(texts: Texts) -> dict[str, bytes]:
    """The robot's documents with other texts at some places."""

    def made(name: str, node: Any, steps: tuple[str | int, ...]) -> Any:
        if isinstance(node, dict):
            return {
                texts.get((name, (*steps, key, "")), key): made(name, value, (*steps, key))
                for key, value in node.items()
            }
        if isinstance(node, list):
            return [made(name, value, (*steps, at)) for at, value in enumerate(node)]
        return texts.get((name, steps), node)

    return {
        name: as_bytes(flow(made(name, root, ())) + "\n") if root is not None else TREE[name].encode()
        for name, root in data().items()
    }


def artefacts(texts: Texts) -> tuple[dict[str, str] | None, list[dict[str, Any]], dict[str, bytes]]:
    """Everything that is made of the documents, by name; what is wrong with them; and the documents."""
    written = documents(texts)
    with standing_in(written) as folder:
        for path in folder.rglob("*.yaml"):
            path.chmod(0o600)  # a text may look like a secret, of which nothing is to be said here
        _, found = told("check", ".")
        errors = [each for each in found if each["severity"] == "error"]
        if errors:
            run("compile")
            return None, errors, written
        _, more = told("compile")
        errors = [each for each in more if each["severity"] == "error"]
        if errors:
            return None, errors, written
        made = {name: text for name, text in read_tree(folder).items() if _is_made(name)}
        for form in FORMS["graph"]:
            made[f"graph.{form}"] = _printed("graph", "robot.ddsl.yaml", "--as", form)
        for form in FORMS["export"]:
            printed = _printed("deploy", "export", "robot.ddsl.yaml", "--as", form, "--format", "json")
            for name, text in json.loads(printed)["files"].items():
                made[f"{form}/{name}"] = text
        made["export.ice-config"] = _printed("config", "export", "speech/etc/config.yaml")
        made["export.toml"] = _printed("config", "export", "speech/etc/config.yaml", "--as", "toml")
        run("config", "show", "speech/etc/config.yaml")
        return {name: text.replace(str(folder), "/robot") for name, text in made.items()}, [], written


def _is_made(name: str) -> bool:
    first, *_ = name.split("/")
    return not (name in TREE or first == ".vscode" or "/.rcyaml/" in f"/{name}" or "/runtime/" in name)


def _printed(*args: str) -> str:
    result = run(*args)
    assert result.exit_code == 0, (args, result.output)
    return result.stdout


def refused(errors: list[dict[str, Any]], written: dict[str, bytes], texts: Texts) -> set[Place]:
    """The places of hostile texts at which something is wrong."""
    found = set()
    for error in errors:
        root, _ = parse(error["file"], written[error["file"]].decode("utf-8", "replace"))
        steps = tuple(_steps(root, (error["line"], error["column"])))
        inner = [
            place
            for place in texts
            if place[0] == error["file"]
            and (steps[: len(place[1])] == place[1] or place[1][: len(steps)] == steps or place[1][:-1] == steps)
        ]
        found.update(inner or texts)  # it may follow from any of them
    return found


def _steps(node: Node | None, at: tuple[int, int]) -> Iterator[str | int]:
    items: list[tuple[str | int, Node, Node]] = []
    if isinstance(node, Mapping):
        items = [(key.lexeme, key, value) for key, value in node.items()]
    elif isinstance(node, Sequence):
        items = [(number, item, item) for number, item in enumerate(node.items)]
    for name, key, value in items:
        if (key.span.line, key.span.column) <= at < (value.span.end_line, value.span.end_column):
            yield name
            if at < (key.span.end_line, key.span.end_column) and isinstance(key, Scalar) and key is not value:
                yield ""
            else:
                yield from _steps(value, at)
            return


IMPOSSIBLE = re.compile("[\0-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
PROSE = ("doc", "unit", "else")


def same_structure(hostile: Texts) -> None:
    """With the texts that are not refused, everything is as with harmless ones."""
    texts = {place: text for place, text in hostile.items() if text.strip() or place[1][-1] not in PROSE}  # blank: none
    while True:
        made, errors, written = artefacts(texts)
        if made is not None:
            break
        wrong = refused(errors, written, texts)
        assert wrong, (errors, texts)
        texts = {place: text for place, text in texts.items() if place not in wrong}
    words = {place: f"Free{number}word" for number, place in enumerate(texts)}
    plain, errors, _ = artefacts(words)
    assert plain is not None, (errors, words)
    # a list may be split, a file be named by a text: as many artefacts, called alike
    assert sorted(made) == sorted(plain)
    meant = {word: texts[place] for place, word in words.items()}
    for name, text in made.items():
        if text != plain[name]:
            told = {word: drawn(name, text) for word, text in meant.items()}
            assert with_texts(structure(name, text), {}) == with_texts(structure(name, plain[name]), told), name


def drawn(name: str, text: str) -> str:
    """A text as an artefact can hold it: XML knows few control characters, and no property is empty."""
    return IMPOSSIBLE.sub("\ufffd", text) if name.endswith(".xml") else text


def with_texts(node: Any, meant: dict[str, str]) -> Any:
    """A structure with the hostile texts in the place of the harmless ones."""
    if isinstance(node, dict):
        made = {with_texts(key, meant): with_texts(value, meant) for key, value in node.items()}
        return {key: value for key, value in made.items() if value != ""}  # an empty text has no property
    if isinstance(node, list | tuple):
        return [with_texts(item, meant) for item in node]
    if isinstance(node, str) and "Free" in node:
        for word, text in meant.items():
            node = node.replace(word, text)
    return node


HOSTILE = st.sampled_from(STRINGS)


@given(st.lists(st.tuples(st.integers(0, 10**6), HOSTILE), min_size=1, max_size=60))
@examples(5, times=8)
def test_everywhere(chosen: list[tuple[int, str]]) -> None:
    free = places(free=True)
    same_structure({free[number % len(free)]: text for number, text in chosen})


@given(st.integers(0, 10**6), HOSTILE | st.text(max_size=4))
@example(799, "http://a:b@c/")  # a warning in the graph
@examples(5, times=8)
def test_in_one_place(number: int, text: str) -> None:
    every = places(free=False)
    same_structure({every[number % len(every)]: text})
