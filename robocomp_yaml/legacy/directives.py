"""Preprocessor directives and metadata between the constructs of a Slice file."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import zip_longest

from lark import Token

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.legacy.draft import Reader

_WORD = re.compile(r"#\s*(\w*)\s*(.*)", re.DOTALL)


def review(trivia: Sequence[Token], reader: Reader) -> None:
    """Report what is lost. An include guard (`#ifndef X`, `#define X`, …, `#endif`, or `#pragma once`) is not lost: the
    generated Slice file has one."""
    _metadata(trivia, reader)
    open_: list[tuple[Token, bool]] = []
    directives = [token for token in trivia if token.type == "DIRECTIVE"]
    for token, following in zip_longest(directives, directives[1:]):
        word, rest = _parts(token)
        if word.startswith("if"):
            guard = word == "ifndef" and following is not None and _parts(following) == ("define", rest)
            open_.append((token, guard))
        elif word == "endif" and not open_:
            reader.repaired("lenient_stray_directive", token, _flat(token))
        elif word == "endif":
            opening, guard = open_.pop()
            for each in [] if guard else [opening, token]:
                reader.lost("DIRECTIVE", each, _flat(each))
        elif word == "include":
            reader.refused("refused_include", token)
        elif not (word == "define" and open_ and open_[-1][1]) and (word, rest) != ("pragma", "once"):
            reader.lost("DIRECTIVE", token, _flat(token))
    for token, guard in open_:
        if not guard:
            reader.lost("DIRECTIVE", token, _flat(token))


def _metadata(trivia: Sequence[Token], reader: Reader) -> None:
    """Report adjacent metadata as one. They become comments."""
    groups: list[list[Token]] = []
    for token in trivia:
        if token.type == "METADATA":
            before = groups[-1][-1].end_pos if groups else None
            if before is not None and not reader.source.text[before : token.start_pos].strip():
                groups[-1].append(token)
            else:
                groups.append([token])
    for first, *rest in groups:
        text = _flat(first) + (f" (and {len(rest)} more)" if rest else "")
        reader.report(codes.METADATA, first, text=text)


def _parts(token: Token) -> tuple[str, str]:
    match = _WORD.match(str(token))
    return (match[1], match[2].strip()) if match else ("", "")


def _flat(token: Token) -> str:
    return " ".join(str(token).split())
