"""Texts that a document shall give back exactly: numbers stand there as they are spelled."""

from __future__ import annotations

import re

from robocomp_yaml.legacy.document import Raw

_NUMBER = re.compile(r"-?(?:0|[1-9][0-9]{0,15})(?:\.[0-9]{1,17})?")


def exact(text: str) -> str | Raw:
    """A plain number where it is one; everything else is text, in quotes where it has to be."""
    return Raw(text) if _NUMBER.fullmatch(text) else text
