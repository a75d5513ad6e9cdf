"""The first values document of a component: what must be given, with examples; what may be, as comments."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from robocomp_yaml.model.parameters import EnumType, Member, Parameters, RecordType
from robocomp_yaml.values.fitting import Fitted, fitted
from robocomp_yaml.values.json_schema import in_words
from robocomp_yaml.values.spell_yaml import comment, flow, scalar


Sections = list[tuple[str, list[tuple[str, str]]]]

_NO_EXAMPLE = "# no example was found that fits the constraints: {}"


def new_document(
    parameters: Parameters, component: str, modeline: str, sections: Sections, values: Mapping[str, Any] | None = None
) -> str:
    """The text; `component` is a path from the document. `sections` (`endpoints`, `proxies` …) come with their entries,
    `values` are those of parameters that are known already."""
    return "".join(f"{line}\n" for line in _lines(parameters, component, modeline, sections, values))


def _lines(
    parameters: Parameters, component: str, modeline: str, sections: Sections, values: Mapping[str, Any] | None
) -> Iterator[str]:
    yield modeline
    yield f"component: {scalar(component)}"
    yield ""
    yield "# What stands without a # needs a value. A line with # shows a default: take the # away to change it."
    yield "parameters:"
    yield from _record(parameters.root, "  ", (), fitted(parameters, values))
    for name, entries in sections:
        if entries:
            yield ""
            yield f"{name}:"
            yield from (f"  {scalar(key)}: {scalar(value)}" for key, value in entries)


def _record(record: RecordType, indent: str, above: tuple[str, ...], found: Fitted) -> Iterator[str]:
    for member in record.members:
        yield from _about(member, indent)
        path, name = (*above, member.name), scalar(member.name)
        if member.is_group and isinstance(member.type, RecordType):
            yield f"{indent}{name}:"
            yield from _record(member.type, f"{indent}  ", path, found)
        elif path in found.given:
            yield f"{indent}{name}: {flow(found.given[path])}"
        elif path in found.possible:
            yield indent + placeholder(member.name, found.possible[path])
        else:
            yield indent + _NO_EXAMPLE.format("give it a value" if member.required else "it may be left out")
            yield f"{indent}# {name}:"


def placeholder(name: str, value: object) -> str:
    """The line of a value that is not given: with the # taken away, it is."""
    return f"# {scalar(name)}: {flow(value)}"


def _about(member: Member, indent: str) -> Iterator[str]:
    doc = member.doc or (member.type.doc if isinstance(member.type, RecordType | EnumType) else "")
    for line in doc.strip().splitlines():
        yield indent + comment(line)
    if not member.is_group:
        facts = [in_words(member.type)]
        facts += ["may be left out"] if member.optional else []
        facts += ["may change while running"] if member.editable else []
        yield indent + comment("; ".join(facts))
