"""The lines of a property file, in sections; and the dialects that it can have. All processes of a network have such
lines, but few have values of parameters, which the other modules write."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import msgspec
from msgspec.structs import replace

from robocomp_yaml import secrets
from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.build_interface import text
from robocomp_yaml.parameters.documents import LayeredValues
from robocomp_yaml.secrets import HIDDEN
from robocomp_yaml.source.properties import entry_line

CLASSIC, FLAT_TOML, TOML = "classic", "flat-toml", "toml"


class Property(msgspec.Struct, frozen=True):
    """One line of a property file. `read` returns the value that another text would have (None if the text is the
    value), so that another spelling of the same value is possible. `secret`: the value is secret."""

    key: str
    value: str
    span: Span | None = None
    read: Callable[[str], Any] | None = None
    secret: bool = False

    def hidden(self) -> Property:
        """The line as it may be shown."""
        return replace(self, value=HIDDEN if self.secret else secrets.value(self.key, self.value))


class Section(msgspec.Struct, frozen=True):
    """Related properties under a title."""

    title: str
    properties: list[Property] = []


def dialect(values: LayeredValues) -> str:
    """The dialect of the property file: CLASSIC, FLAT_TOML or TOML."""
    for layer in reversed(values.layers()):
        if found := text(layer.document.root.get("legacy"), "dialect"):
            return found
    return CLASSIC


def section_text(sections: list[Section]) -> str:
    lines = []
    for section in sections:
        lines += ["", f"# {section.title}.", *(entry_line(made.key, made.value) for made in section.properties)]
    return "".join(f"{line}\n" for line in lines)


def secret_keys(sections: list[Section]) -> tuple[str, ...]:
    """The names of the secret properties."""
    return tuple(sorted(made.key for section in sections for made in section.properties if made.secret))
