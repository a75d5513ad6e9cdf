"""Which legacy format a file is in: told by its content, and by its name where the content does not tell."""

from __future__ import annotations

import os

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.legacy.reading import Source
from robocomp_yaml.legacy.rules import Rules, formats
from robocomp_yaml.legacy.syntax_error import without_silent


def by_name(path: str) -> Rules | None:
    """The format that a file's suffix says."""
    suffix = os.path.splitext(path)[1].lower()
    return next((rules for rules in formats() if suffix in rules.suffixes), None)


def recognize(source: Source) -> tuple[Rules | None, list[Diagnostic]]:
    """The format of a text; None with the reason where it is in none."""
    said = by_name(source.path)
    content = without_silent(source.text)
    if not content.strip():
        what = "nothing but comments" if source.text.strip() else "nothing"
        return None, [codes.EMPTY.at(Span(source.path), what=what)]
    fitting = [rules for rules in formats() if rules.signature.search(content)]
    if said is not None and (said in fitting or not fitting):
        return said, []
    if not fitting:
        known = ", ".join(f"{rules.title} ({', '.join(rules.suffixes)})" for rules in formats())
        return None, [codes.UNKNOWN_FORMAT.at(Span(source.path), formats=known)]
    found = fitting[0]
    if said is None:
        return found, []
    return found, [codes.OTHER_FORMAT.at(Span(source.path), said=said.title, found=found.title)]
