"""What stands between the constructs of a Slice file: guards, conditions and metadata."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from lark import Token

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.legacy.reading import Source
from robocomp_yaml.legacy.rules import Rules

_WORD = re.compile(r"#\s*(\w*)\s*(.*)", re.DOTALL)


def review(trivia: Sequence[Token], source: Source, rules: Rules) -> list[Diagnostic]:
    """What of it is lost. A guard (`#ifndef X`, `#define X`, …, `#endif`, or `#pragma once`) is not: we write it."""
    said = list(_metadata(trivia, source, rules))
    open_: list[tuple[Token, bool]] = []
    directives = [token for token in trivia if token.type == "DIRECTIVE"]
    for number, token in enumerate(directives):
        word, rest = _parts(token)
        if word.startswith("if"):
            guard = word == "ifndef" and _parts(directives[number + 1]) == ("define", rest) if (
                number + 1 < len(directives)
            ) else False  # fmt: skip
            open_.append((token, guard))
        elif word == "endif":
            if not open_:
                what = rules.repairs["lenient_stray_directive"].format(text=_flat(token))
                said.append(codes.REPAIRED.at(_span(token, source), what=what))
                continue
            begun, guard = open_.pop()
            said += [] if guard else [_lost(begun, source, rules), _lost(token, source, rules)]
        elif word == "include":
            said.append(codes.REFUSED.at(_span(token, source), reason=rules.refusals["refused_include"]))
        elif not (word == "define" and open_ and open_[-1][1]) and (word, rest) != ("pragma", "once"):
            said.append(_lost(token, source, rules))
    said += [_lost(token, source, rules) for token, guard in open_ if not guard]
    return said


def _metadata(trivia: Sequence[Token], source: Source, rules: Rules) -> Iterator[Diagnostic]:
    """One loss for metadata that stands together."""
    groups: list[list[Token]] = []
    for token in trivia:
        if token.type == "METADATA":
            start, before = token.start_pos or 0, groups[-1][-1].end_pos if groups else None
            if before is not None and not source.text[before:start].strip():
                groups[-1].append(token)
            else:
                groups.append([token])
    for group in groups:
        more = f" (and {len(group) - 1} more)" if len(group) > 1 else ""
        yield codes.LOST.at(_span(group[0], source), what=rules.losses["METADATA"].format(text=_flat(group[0]) + more))


def _parts(token: Token) -> tuple[str, str]:
    found = _WORD.match(str(token))
    return (found[1], found[2].strip()) if found else ("", "")


def _flat(token: Token) -> str:
    return " ".join(str(token).split())


def _span(token: Token, source: Source) -> Span:
    return source.span(token.start_pos or 0, token.end_pos or 0)


def _lost(token: Token, source: Source, rules: Rules) -> Diagnostic:
    return codes.LOST.at(_span(token, source), what=rules.losses["DIRECTIVE"].format(text=_flat(token)))
