"""The values of a flat `etc/config` that rcyaml wrote, which are judged like those of a values document."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator

from msgspec.structs import replace

from robocomp_yaml.addresses.own import is_own, replaces_values
from robocomp_yaml.diag.codes import values as codes
from robocomp_yaml.diag.diagnostic import WARNING, Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean, suggest
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.link.flat_configs import FlatConfig, flat_config
from robocomp_yaml.link.program import LinkedComponent, Program
from robocomp_yaml.parameters.types import BasicType, EnumType, RecordType, Type, below, leaves

_NEAR = 0.8  # similarity of a name that is surely misspelled
_OWN = "a property of your own belongs under `properties:` of an etc/config.yaml, which `{}` writes"


def check(program: Program) -> Iterator[Diagnostic]:
    own = {one.parameters.component: one for one in program.values.values() if one.parameters and is_own(one)}
    for linked in sorted(program.components.values(), key=lambda linked: linked.component.path):
        if linked.broken or linked.parameters.broken:
            continue
        flat = flat_config(os.path.dirname(linked.component.path), program.disk)
        if flat is None:
            continue
        if flat.is_written and (linked not in own or replaces_values(flat, own[linked])):
            yield from _values(flat, linked)


def replaced(program: Program, components: Iterable[LinkedComponent]) -> Iterator[Diagnostic]:
    """A warning for each of these components that has the values of its flat config instead of those of its values
    document. A compile, which ends this, reports it in its own way."""
    own = {one.parameters.component: one for one in program.values.values() if one.parameters and is_own(one)}
    for linked in components:
        values = own.get(linked)
        flat = flat_config(os.path.dirname(linked.component.path), program.disk) if values is not None else None
        if values is not None and flat is not None and replaces_values(flat, values):
            document = values.document.path
            hint = f"move your changes to {document}, then `{typed('rcyaml', 'compile', linked.component.path)}`"
            yield codes.CHANGED_FLAT.at(Span(flat.path), path=flat.path, document=document, hint=hint)


def _values(flat: FlatConfig, linked: LinkedComponent) -> Iterator[Diagnostic]:
    from robocomp_yaml.addresses.flat_values import flat_values
    from robocomp_yaml.parameters.layers.effective import document_faults

    found, root = flat_values(flat, linked.parameters, linked), linked.parameters.parameters.root
    # A fix edits documents, and this is none.
    yield from (replace(fault, fixes=()) for fault in document_faults(found.layer, linked.parameters))
    for what, name, span in found.unknown_ports.values():
        ports = linked.requires if what == "proxy" else linked.implements
        meant = suggest(name, [port.name for port in ports])
        if meant and _likeness(name, meant) >= _NEAR:  # another may be one of the component's own code
            own, similar = linked.component.name, f"did you mean '{meant}'?"
            yield codes.UNKNOWN_PORT.at(span, component=own, what=what, name=name, hint=similar)
    known = [*(path for path, _ in leaves(root)), *found.connections]
    new = _OWN.format(typed("rcyaml", "config", "new", linked.component.path))
    for key, span in found.unread.items():
        inside = _inside(key, root)
        hint = did_you_mean(key, known if inside is None else inside, otherwise=new if inside is None else "")
        fault = replace(codes.UNKNOWN_PARAMETER.at(span, path=key, hint=hint), fixes=())
        is_misspelled = inside is not None or (hint.meant and _likeness(key, hint.meant) >= _NEAR)
        yield fault if is_misspelled else fault.as_severity(WARNING)


def _inside(key: str, root: RecordType) -> list[str] | None:
    """The names that a property in a group, record, list or map can have; None if it is not in one."""
    *outer, _ = key.split(".")
    type_: Type | None = root
    for depth, step in enumerate(outer):
        inner = below(type_, step)
        if inner is None:
            return None if depth == 0 else []
        type_ = inner
    if not outer or isinstance(type_, (BasicType, EnumType)):
        return None
    return [".".join((*outer, member.name)) for member in type_.members] if isinstance(type_, RecordType) else []


def _likeness(one: str, other: str) -> float:
    from difflib import SequenceMatcher

    return SequenceMatcher(None, one.lower(), other.lower()).ratio()
