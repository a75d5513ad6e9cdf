"""Skip the files of a folder that are no legacy files, although their names look so, and those without content.

Many programs have files `something.cfg`. If such a file cannot be read, it is another program's, unless its name or its
properties show that it configures a component.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence

from robocomp_yaml.diag.codes import files as file_codes
from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import NOTE, Diagnostic
from robocomp_yaml.diag.listing import some
from robocomp_yaml.diag.span import Span
from robocomp_yaml.legacy.formats import by_name
from robocomp_yaml.legacy.ledger import LedgerEntry
from robocomp_yaml.legacy.rules import Formats

_TEMPLATE = re.compile(r"\$\{\w+\}|\bname_state\b")
_OF_COMPONENTS = re.compile(r"(?mi)^[ \t]*(?:[\w.]*\bEndpoints\b[\w.]*|\w*Proxy|Ice\.[\w.]+)[ \t]*=")


def skip_foreign(entries: Sequence[LedgerEntry], known: Formats) -> list[Diagnostic]:
    """Mark files as skipped: empty ones, broken links and templates, each with a note, and those of other programs.
    Return one note for all of the latter."""
    foreign = []
    for entry in entries:
        if entry.skipped or entry.legacy.is_named or not entry.file.refused:
            continue
        if any(diagnostic.code == codes.EMPTY.id for diagnostic in entry.diagnostics) or _is_broken(entry.file.path):
            entry.skipped = True
            entry.diagnostics = [diagnostic.as_severity(NOTE) for diagnostic in entry.diagnostics]
        elif entry.file.source is None:
            rules = by_name(entry.file.path, known)
            if (rules is None or rules.weak) and any(one.code == file_codes.BINARY.id for one in entry.diagnostics):
                foreign.append(entry.file.path)
                entry.skipped, entry.diagnostics = True, []
        elif _TEMPLATE.search(entry.file.source.text):
            entry.skipped, entry.diagnostics = True, [codes.TEMPLATE.at(Span(entry.file.path))]
        elif not _is_ours(entry, known):
            foreign.append(entry.file.path)
            entry.skipped, entry.diagnostics = True, []
    return [codes.FOREIGN.at(Span(foreign[0]), count=len(foreign), files=some(foreign))] if foreign else []


def _is_broken(path: str) -> bool:
    """Whether a file is a link to a missing one, such as a file of a submodule that was not cloned."""
    return os.path.islink(path) and not os.path.exists(path)


def _is_ours(entry: LedgerEntry, known: Formats) -> bool:
    """Whether a file is RoboComp's: by its suffix, by its name, or by its properties."""
    assert entry.file.source is not None
    path, rules = entry.file.path, by_name(entry.file.path, known)
    name = os.path.basename(path).lower()
    if rules is not None and not rules.weak:
        return True
    if entry.file.rules is not None and entry.file.rules.by_content:
        return True
    is_config = os.path.basename(os.path.dirname(os.path.abspath(path))) == "etc" and name.startswith("config")
    return name == "config" or is_config or bool(_OF_COMPONENTS.search(entry.file.source.text))
