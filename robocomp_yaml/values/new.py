"""The first values document of a component: what must be given, with examples; what may be, as comments."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.model.parameters import EnumType, Member, Parameters, RecordType
from robocomp_yaml.values.example import example
from robocomp_yaml.values.json_schema import in_words
from robocomp_yaml.values.spell_yaml import comment, flow, scalar


def new_document(
    parameters: Parameters, component: str, modeline: str, connections: list[tuple[str, list[tuple[str, str]]]]
) -> str:
    """The text; `component` is a path from the document. `connections` are sections (`endpoints`, `proxies`) with
    their entries."""
    return "".join(f"{line}\n" for line in _lines(parameters, component, modeline, connections))


def _lines(
    parameters: Parameters, component: str, modeline: str, connections: list[tuple[str, list[tuple[str, str]]]]
) -> Iterator[str]:
    yield modeline
    yield f"component: {scalar(component)}"
    yield ""
    yield "# What stands without a # needs a value. A line with # shows a default: take the # away to change it."
    yield "parameters:"
    yield from _record(parameters.root, "  ")
    for name, entries in connections:
        if entries:
            yield ""
            yield f"{name}:"
            yield from (f"  {scalar(key)}: {scalar(value)}" for key, value in entries)


def _record(record: RecordType, indent: str) -> Iterator[str]:
    for member in record.members:
        yield from _about(member, indent)
        if member.is_group and isinstance(member.type, RecordType):
            yield f"{indent}{scalar(member.name)}:"
            yield from _record(member.type, f"{indent}  ")
        else:
            yield f"{indent}{'' if member.required else '# '}{scalar(member.name)}: {flow(example(member))}"


def _about(member: Member, indent: str) -> Iterator[str]:
    doc = member.doc or (member.type.doc if isinstance(member.type, RecordType | EnumType) else "")
    for line in doc.strip().splitlines():
        yield indent + comment(line)
    if not member.is_group:
        facts = [in_words(member.type)]
        facts += ["may be left out"] if member.optional else []
        facts += ["may change while running"] if member.editable else []
        yield indent + comment("; ".join(facts))
