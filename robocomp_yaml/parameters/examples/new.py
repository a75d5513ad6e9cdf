"""The first values document of a component: required values as examples, optional values as comments."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from robocomp_yaml.parameters.types import ResolvedMember, Parameters, RecordType
from robocomp_yaml.semantics.paths import Step
from robocomp_yaml.parameters.examples.fitting import Fitted, fitted
from robocomp_yaml.source.yaml_text import comment, flow, scalar
from robocomp_yaml.parameters.words import for_documents

Sections = list[tuple[str, list[tuple[str, str]]]]

_NO_EXAMPLE = "# no example satisfies the constraints: {}"
_ADVICE = {True: "set a value", False: "optional"}  # by whether it is required


def new_document(
    parameters: Parameters, component: str, modeline: str, sections: Sections, values: Mapping[str, Any] | None = None
) -> str:
    """The text of the document. `component` is a path relative to it. `sections` (`endpoints`, `proxies` …) have their
    entries. `values` are known values of parameters."""
    return "".join(f"{line}\n" for line in _lines(parameters, component, modeline, sections, values))


def _lines(
    parameters: Parameters, component: str, modeline: str, sections: Sections, values: Mapping[str, Any] | None
) -> Iterator[str]:
    yield modeline
    yield f"component: {scalar(component)}"
    yield ""
    yield "# Lines without # need a value. Lines with # show a default: remove the # to change it."
    yield "parameters:"
    yield from _record(parameters.root, "  ", (), fitted(parameters, values))
    for name, entries in sections:
        if entries:
            yield ""
            yield f"{name}:"
            yield from (f"  {scalar(key)}: {scalar(value)}" for key, value in entries)


def _record(record: RecordType, indent: str, outer: tuple[str, ...], found: Fitted) -> Iterator[str]:
    for member in record.members:
        yield from _comments(member, indent)
        path, name = (*outer, member.name), scalar(member.name)
        if member.is_group and isinstance(member.type, RecordType):
            yield f"{indent}{name}:"
            yield from _record(member.type, f"{indent}  ", path, found)
        elif path in found.present:
            yield f"{indent}{name}: {flow(found.present[path])}"
        elif path in found.possible:
            yield f"{indent}# {name}: {flow(found.possible[path])}"
        else:
            yield indent + _NO_EXAMPLE.format(_ADVICE[member.required])
            yield f"{indent}# {name}:"


def _comments(member: ResolvedMember, indent: str) -> Iterator[str]:
    for line in member.documentation.strip().splitlines():
        yield indent + comment(line)
    if not member.is_group:
        yield indent + comment(for_documents(member))


def lines_above(root: RecordType, steps: Sequence[Step]) -> tuple[str, ...]:
    """The possible comments above the commented line of a parameter in a first document; empty if the steps do not lead
    to a parameter of the root or of a group."""
    record, member = root, None
    for step in steps:
        if member is not None and not member.is_group:
            return ()
        record = member.type if member is not None and isinstance(member.type, RecordType) else record
        member = record.member(step) if isinstance(step, str) else None
        if member is None:
            return ()
    if member is None or member.is_group:
        return ()
    words = for_documents(member)
    earlier = words.replace("elements", "entries").replace("element", "entry")  # as earlier versions wrote it
    return comment(words), comment(earlier), *(_NO_EXAMPLE.format(what) for what in _ADVICE.values())
