"""Where the user's code uses a name of the documents: what would change there, if the name did."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping

from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.diag.span import Span
from robocomp_yaml.naming.names import DefinedName, Names
from robocomp_yaml.naming.renaming import renamed
from robocomp_yaml.pipeline import Analysis

_ANOTHER = "Zqx"
_DEFINES = re.compile(
    r"\s*(?:async\s+)?def\s+\Z"  # Python
    r"|.*\w::\Z"  # C++
    r"|\s*(?:(?:@\w+|public|protected|private|final|synchronized)\s+)+[\w.<>\[\], ]+\s\Z",  # Java
    re.DOTALL,
)


def places_in_code(
    analysis: Analysis, names: Names, defined: DefinedName, analyse: Callable[[Mapping[str, bytes]], Analysis]
) -> list[tuple[Span, bool]]:
    """The places, and whether each defines a method. None if the code cannot be followed."""
    try:
        made = renamed(analysis, names, defined, f"{defined.name}{_ANOTHER}", analyse, is_trial=True)
    except Refused:
        return []
    found = []
    for edit in made.edits:
        if edit.is_code:
            lines = made.before[edit.span.file].decode().splitlines()
            before = lines[edit.span.line - 1][: edit.span.column - 1] if edit.span.line <= len(lines) else ""
            found.append((edit.span, _DEFINES.fullmatch(before) is not None))
    return found
