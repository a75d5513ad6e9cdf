"""Entries of `legacy:`. Few documents have some, and the properties of all others are spelled by paths."""

from __future__ import annotations

from dataclasses import dataclass, field

from robocomp_yaml.diag.span import Span
from robocomp_yaml.semantics import spellings


@dataclass(frozen=True)
class LegacySpelling(spellings.Spelling):
    """An entry of `legacy:`: how properties spell the parameter at `path`. `members` are the members of its records,
    where the entry names them."""

    path: str = ""
    span: Span = field(default=Span(""), compare=False)
    members: tuple[tuple[str, Span], ...] = field(default=(), compare=False)
