"""Properties as the text of a file, each section with a word about it."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.parameters.writing.properties import Section
from robocomp_yaml.source.properties import entry_line


def property_text(sections: list[Section], name: str, source: str) -> str:
    """The text of `etc/config` of a component, made of the values document `source` (a path from the file)."""
    head = f"# Configuration of {name}, written by rcyaml from {source}: change it there, and compile again."
    return f"{head}\n{section_text(sections)}"


def section_text(sections: list[Section]) -> str:
    return "".join(f"{line}\n" for line in _lines(sections))


def _lines(sections: list[Section]) -> Iterator[str]:
    for section in sections:
        yield ""
        yield f"# {section.title}."
        for made in section.properties:
            yield entry_line(made.key, made.value)
