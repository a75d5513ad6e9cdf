"""Values documents as people write them: data laid out in YAML in many ways, with comments that must stay."""

from __future__ import annotations

import json
from collections.abc import Iterator
from random import Random
from typing import Any

from robocomp_yaml.parameters.spelling.yaml import flow, scalar, single_quoted


def laid_out(data: dict[str, Any], random: Random) -> bytes:
    """A document with these entries, in one of the layouts that YAML has for it."""
    layout = _Layout(random)
    lines = ["# first", *layout.mapping(data, "")]
    line_end = random.choice(("\n", "\n", "\r\n"))
    text = line_end.join(lines) + random.choice((line_end, line_end, "", f"{line_end}{line_end}# last"))
    return (b"\xef\xbb\xbf" if random.random() < 0.1 else b"") + text.encode()


class _Layout:
    def __init__(self, random: Random) -> None:
        self.random = random
        self.comments = 0

    def comment(self) -> str:
        """At the end of a line, sometimes."""
        self.comments += 1
        return f"{self.random.choice((' ', '   '))}# c{self.comments}" if self.random.random() < 0.3 else ""

    def between(self, indent: str) -> Iterator[str]:
        """Lines without a value, sometimes."""
        if self.random.random() < 0.2:
            self.comments += 1
            yield self.random.choice(("", f"{indent}# c{self.comments}", f"# c{self.comments}"))

    def mapping(self, data: dict[str, Any], indent: str) -> Iterator[str]:
        for key, value in data.items():
            yield from self.between(indent)
            yield from self.entry(f"{indent}{self.key(key)}:", value, indent)

    def sequence(self, items: list[Any], indent: str) -> Iterator[str]:
        for item in items:
            yield from self.between(indent)
            if isinstance(item, dict) and item and self.random.random() < 0.5:
                first, *rest = self.mapping(item, f"{indent}  ")
                if first.strip() and not first.strip().startswith("#"):
                    yield f"{indent}- {first.strip()}"
                    yield from rest
                    continue
            yield f"{indent}- {self.plain(item)}{self.comment()}"

    def entry(self, head: str, value: Any, indent: str) -> Iterator[str]:
        if isinstance(value, dict | list) and value and (not indent or self.random.random() < 0.6):
            yield f"{head}{self.comment()}"
            inner = indent + self.random.choice(("  ", "    "))
            yield from (
                self.mapping(value, inner)
                if isinstance(value, dict)
                else self.sequence(value, self.random.choice((inner, indent)))
            )
        else:
            yield f"{head}{self.random.choice((' ', ' ', '  '))}{self.plain(value)}{self.comment()}"

    def key(self, key: str) -> str:
        return json.dumps(key, ensure_ascii=True) if self.random.random() < 0.1 else scalar(key)

    def plain(self, value: Any) -> str:
        if isinstance(value, str) and self.random.random() < 0.3:
            return single_quoted(value)
        text = flow(value)
        return (
            text.replace(", ", " , ")
            if isinstance(value, list) and '"' not in text and self.random.random() < 0.2
            else text
        )
