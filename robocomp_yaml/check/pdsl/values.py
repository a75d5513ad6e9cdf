"""Values documents: their texts for Ice, ports and layers, and their effective values."""

from __future__ import annotations

import os
from collections.abc import Iterator
from functools import partial

from robocomp_yaml.diag.codes import values as codes
from robocomp_yaml.diag.diagnostic import WARNING, Diagnostic, has_errors
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.link.attachments import refers_to
from robocomp_yaml.link.program import LinkedComponent, LinkedParameters, LinkedValues, Program
from robocomp_yaml.model.build_interface import entries
from robocomp_yaml.parameters.layers.effective import Effective, document_faults
from robocomp_yaml.parameters.writing.properties import properties
from robocomp_yaml.parameters.writing.writable import is_surely_writable
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source.ice_texts import ENDPOINT, PROXY, of_text
from robocomp_yaml.source.tree import Mapping, Node, Scalar


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in sorted(program.values.values(), key=lambda values: values.document.path):
        part = "values", linked.document.path
        yield from program.memory.listed(part, (linked,), partial(check_document, linked, program))


def check_document(linked: LinkedValues, program: Program, *, complete: bool = False) -> Iterator[Diagnostic]:
    """Checks a values document; with `complete` as the values of a component, even if other documents extend it."""
    yield from texts_of_ice(linked)
    if linked.parameters is None:
        if not linked.is_extended and not linked.document.component and not linked.broken:
            yield codes.NO_COMPONENT.at(linked.document.root.span)
        return
    if linked.parameters.broken:
        return
    yield from _layers(linked)
    yield from _ports(linked)
    if is_only_a_layer(linked) and not complete:
        yield from document_faults(linked, linked.parameters)
        return
    values, diagnostics = program.effective(linked)
    yield from diagnostics
    if values is not None and not has_errors(diagnostics) and not has_only_harmless_parameters(linked, values):
        yield from properties(linked, values)[1]


def texts_of_ice(linked: LinkedValues) -> Iterator[Diagnostic]:
    """Reports endpoints and proxies that Ice would reject."""
    root = linked.document.root
    manager = root.get("topics")
    texts: list[tuple[str, Node | None]] = [(ENDPOINT, node) for node in _own(root.get("endpoints"))]
    texts += [(PROXY, node) for node in _own(root.get("proxies"))]
    texts += [(PROXY, manager.get("manager"))] if isinstance(manager, Mapping) else []
    for what, value in texts:
        node = value.get("proxy") if isinstance(value, Mapping) else value
        if not isinstance(node, Scalar) or node.data is None:
            continue
        if not unquoted(node.lexeme) and not linked.document.path.endswith(".yaml"):
            continue  # of a flat config: it is not set
        if (fault := of_text(what, node)) is not None:
            yield fault.as_severity(WARNING) if "legacy" in root.entries else fault


def _own(section: Node | None) -> Iterator[Node]:
    """The values of a section, without those under `x-…`."""
    for name, node in section.items() if isinstance(section, Mapping) else ():
        if not name.lexeme.startswith("x-"):
            yield node


def is_only_a_layer(linked: LinkedValues) -> bool:
    """Whether a document may be incomplete, because other documents extend it."""
    return linked.is_extended and os.path.basename(linked.document.path) != "config.yaml"


def has_only_harmless_parameters(linked: LinkedValues, values: Effective) -> bool:
    """Whether the layers contain only parameters, whose values are all harmless as properties."""
    keys = {key for layer in linked.layers() for key in layer.document.root.entries}
    return keys <= {"component", "doc", "extends", "parameters"} and is_surely_writable(values.parameters, values.data)


def _layers(linked: LinkedValues) -> Iterator[Diagnostic]:
    """Reports layers that belong to another component."""
    for base in linked.extends:
        if base.parameters is not None and base.parameters is not linked.parameters:
            real = os.path.realpath(base.document.path)
            layer = next(each for each in linked.document.extends if refers_to(each, linked.document, real))
            yield codes.OTHER_COMPONENT.at(
                layer.span, name=layer.value, other=_owner(base.parameters), own=_owner(linked.parameters)
            )


def _owner(parameters: LinkedParameters | None) -> str:
    """The name of the component, or of the parameter document if it has no component."""
    assert parameters is not None
    if parameters.component is not None:
        return parameters.component.component.name
    return os.path.basename(parameters.document.path) if parameters.document is not None else "no component"


def port_names(component: LinkedComponent) -> dict[tuple[str, ...], tuple[str, list[str]]]:
    """What the keys of a values document below some of its sections are called, and which ones there can be."""
    served = [port.name for port in component.implements] + ["CommonBehavior"]
    served += [name for port in component.subscribes for name in (port.name, f"{port.name}Topic")]
    topics = [port.name for port in (*component.publishes, *component.subscribes)]
    return {
        ("endpoints",): ("interface", served),
        ("proxies",): ("proxy", [port.name for port in component.requires]),
        ("topics", "name"): ("topic", topics),
        ("topics", "prefix"): ("topic", topics + [f"{name}Pub" for name in topics]),
    }


def _ports(linked: LinkedValues) -> Iterator[Diagnostic]:
    component = linked.parameters.component if linked.parameters else None
    if component is None or component.broken:
        return
    for section, (what, names) in port_names(component).items():
        parent = linked.document.section(*section[:-1])
        for name, _ in entries(parent, section[-1]):
            if name.lexeme not in names and name.lexeme.removesuffix("Comp") not in names:
                others = {other.lexeme for other, _ in entries(parent, section[-1])}
                yield codes.UNKNOWN_PORT.at(
                    name.span,
                    component=component.component.name,
                    what=what,
                    name=name.lexeme,
                    hint=did_you_mean(name.lexeme, names, others),
                )
