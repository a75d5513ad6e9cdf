"""Names in generated code, which is not renamed, but compiled: there, the spelling of a word decides which name of the
documents it means, among those that the component uses."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence

from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.layout import SOURCES
from robocomp_yaml.link.program import LinkedComponent, Program
from robocomp_yaml.naming import names as kinds
from robocomp_yaml.naming.names import DefinedName, Names
from robocomp_yaml.source.text import read_bytes

GENERATED = "generated"
_IN_CODE = (
    kinds.METHOD, kinds.EVENT, kinds.PARAMETER, kinds.STATE, kinds.PORT, kinds.TYPE, kinds.EXCEPTION, kinds.ENUMERATOR,
    kinds.CONSTANT, kinds.INTERFACE, kinds.TOPIC, kinds.MODULE,
)  # fmt: skip
"""The kinds of names in code, the most special first."""
_MANY = 20  # components in which a name is searched


def component_of(program: Program, path: str) -> tuple[LinkedComponent | None, str]:
    """The component to whose code a file belongs, and whether that is the user's or generated."""
    for real, linked in program.components.items():
        inside = os.path.relpath(path, os.path.dirname(real)).split(os.sep)
        if inside[0] in (SOURCES, GENERATED):
            return linked, inside[0]
    return None, ""


def names_of_component(names: Names, linked: LinkedComponent) -> list[DefinedName]:
    """The names in the documents of a component."""
    documents = {linked.component.path, *(scope.module.path for scope in linked.modules())}
    if linked.parameters.document is not None:
        documents.add(linked.parameters.document.path)
    return [one for one in names.of_kinds(*_IN_CODE) if one.key[1] in documents and one.name]


def meant_by(known: Sequence[DefinedName], word: str, at: int) -> list[DefinedName]:
    """The names that a word may mean, the most probable one first: those at the index `at`, then the longest."""
    found = []
    for one in known:
        if parts := list(_parts(word, one.name)):
            is_there = any(start <= at <= end for start, end in parts)
            found.append((not is_there, -len(one.name), _IN_CODE.index(one.kind), one.key, one))
    return [one[-1] for one in sorted(found, key=lambda each: each[:-1])]


def _parts(word: str, name: str) -> Iterator[tuple[int, int]]:
    """Where a name is in a word, as a part of it: `say` is in `Speech_say` and `sayAsync`, and not in `essays`."""
    lower, start = name.lower(), -1
    while (start := word.lower().find(lower, start + 1)) >= 0:
        end = start + len(name)
        begins = start == 0 or not word[start - 1].isalnum() or word[start].isupper()
        if begins and not word[end : end + 1].islower():
            yield start, end


def places_in_generated(program: Program, names: Names, one: DefinedName) -> Iterator[Span]:
    """Where generated code of components has a name of their documents."""
    if one.kind not in _IN_CODE:
        return
    searched = 0
    for real, linked in program.components.items():
        known = names_of_component(names, linked)
        if one not in known:
            continue
        searched += 1
        if searched > _MANY:
            return
        for path in _files(os.path.join(os.path.dirname(real), GENERATED), linked.component.language.target.suffixes):
            raw, _ = read_bytes(path)
            text = raw.decode("utf-8", "replace") if raw is not None else ""
            yield from _in_text(path, text, known, one)


def _in_text(path: str, text: str, known: Sequence[DefinedName], one: DefinedName) -> Iterator[Span]:
    words = re.compile(rf"\w*{re.escape(one.name)}\w*", re.IGNORECASE)
    for number, line in enumerate(text.splitlines(), 1):
        for word in words.finditer(line):
            if any(
                meant_by(known, word[0], (start + end) // 2)[:1] == [one] for start, end in _parts(word[0], one.name)
            ):
                yield Span(path, number, word.start() + 1, number, word.end() + 1)


def _files(folder: str, suffixes: Sequence[str]) -> Iterator[str]:
    """The source files in a folder of generated code, without what they share."""
    try:
        found = sorted(os.listdir(folder))
    except OSError:
        return
    yield from (os.path.join(folder, name) for name in found if name.rpartition(".")[2] in suffixes)
