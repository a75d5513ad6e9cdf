"""Completion for editors without a protocol of their own, such as the page of the manager: plain texts, and where they
go."""

from __future__ import annotations

import re

import msgspec

from robocomp_yaml.api.completing import schema_keys
from robocomp_yaml.api.completing.places import typed_at
from robocomp_yaml.api.completing.proposal import Proposal
from robocomp_yaml.api.completing.proposals import codes_at, importing, proposals
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import Edit
from robocomp_yaml.link.workspace import above
from robocomp_yaml.naming.names import Names
from robocomp_yaml.pipeline import Analysis

_LINE_END = re.compile("\r\n|\r|\n")
_FIELD = re.compile(r"\$\{\d+:([^}]*)\}|\$\{\d+\|([^,|]*)[^}]*\}|\$\{\d+\}|\$\d+")


class CompletionChoice(msgspec.Struct, frozen=True):
    """`insert` replaces the columns from `start` to `end` of the line of the cursor, which count characters from 1.
    `edits` are made as well: the import that a name needs."""

    label: str
    detail: str
    insert: str
    start: int
    end: int
    doc: str = ""
    edits: tuple[Edit, ...] = ()


def choices(
    analysis: Analysis, known: Names, path: str, text: str, line: int, column: int, found: list[Diagnostic]
) -> list[CompletionChoice]:
    """What can be typed at a line and column (from 1) of a text. `analysis` and `known` may be those of an earlier
    text; `found` are the diagnostics of the document."""
    lines = _LINE_END.split(text)
    if not (0 < line <= len(lines) and column > 0):
        return []
    own = lines[line - 1]
    coded = codes_at(own, column, found, line)
    if coded is not None:
        return [_choice(one, own, coded[0], column, ()) for one in coded[1]]
    place = typed_at(text, line, column)
    if place is None:
        return []
    importable = analysis.search.known(path, above(path, analysis.search.disk)[0])
    made = proposals(path, place, known, importable, analysis.program, with_schema=True)
    return [
        _choice(one, own, place.column, place.end_column, tuple(importing(path, place, one.imports))) for one in made
    ]


def _choice(one: Proposal, line: str, start: int, end: int, edits: tuple[Edit, ...]) -> CompletionChoice:
    insert = one.snippet or one.text
    if one.kind == schema_keys.SNIPPET:
        insert = _FIELD.sub(lambda found: found[1] or found[2] or "", insert).replace("\\$", "$")
    indent = line[: len(line) - len(line.lstrip())]
    return CompletionChoice(
        one.text.removesuffix(": "), one.says, insert.replace("\n", f"\n{indent}"), start, end, one.doc, edits
    )
