"""From the user's code, generated code and Slice to the documents: which name of theirs a word in code means.

A word in the user's code means a name if renaming the name would change the word there. In generated code, its spelling
decides.
"""

from __future__ import annotations

import os
import re

from robocomp_yaml.diag.span import Span
from robocomp_yaml.lsp.session import KnownNames, Session
from robocomp_yaml.naming.in_generated import GENERATED, component_of, meant_by, names_of_component
from robocomp_yaml.naming.in_slice import SUFFIX, files_of_slice, meant_in_slice, places_in_slice
from robocomp_yaml.naming.names import DefinedName
from robocomp_yaml.naming.places_in_code import places_in_code

_MOST = 6  # names that are tried


def name_in_code(session: Session, path: str, line: int, column: int) -> tuple[Span, DefinedName] | None:
    """The name of a document that the word at a place in code, or in Slice, means, with the location of the word."""
    if path.endswith(SUFFIX):
        known = session.names_around(path)
        return meant_in_slice(known.program, known.names, path, session.text_of(path), line, column)
    lines = session.text_of(path).splitlines()
    text = lines[line - 1] if line <= len(lines) else ""
    word = next((one for one in re.finditer(r"\w+", text) if one.start() < column <= one.end() + 1), None)
    known = session.names_around(path)
    linked, part = component_of(known.program, path)
    if word is None or linked is None:
        return None
    span = Span(path, line, word.start() + 1, line, word.end() + 1)
    workspace = session.workspace_of(path)
    look = workspace.living.look(workspace.root)
    for one in meant_by(names_of_component(known.names, linked), word[0], column - word.start() - 1)[:_MOST]:
        if part == GENERATED:
            return span, one
        places = places_in_code(look.analysis, known.names, one, lambda texts: look.with_texts(texts).analysis)
        if any(place == Span(place.file, *_rest(span)) and os.path.realpath(place.file) == path for place, _ in places):
            return span, one
    return None


def in_slice(session: Session, known: KnownNames, one: DefinedName) -> list[Span]:
    """Where files of Slice in the workspace of a name have it."""
    folders = {settings.slice_folder for settings in known.analysis.workspaces.declared}
    files = files_of_slice(session.workspace_of(one.span.file).root, sorted(folders))
    return places_in_slice(known.program, known.names, one, ((path, session.text_of(path)) for path in files))


def _rest(span: Span) -> tuple[int, int, int, int]:
    return span.line, span.column, span.end_line, span.end_column
