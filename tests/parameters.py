"""Parameters and values out of texts, for tests."""

from __future__ import annotations

from typing import Any

from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.link.program import LinkedParameters, LinkedValues
from robocomp_yaml.parameters.resolution.resolve import resolve
from robocomp_yaml.parameters.specification import build as build_parameters
from robocomp_yaml.parameters.types import Parameters
from robocomp_yaml.parameters.writing.sections import Section
from robocomp_yaml.source import schema
from robocomp_yaml.source.tree import Mapping, Node, parse
from robocomp_yaml.source.yaml_text import flow

Data = dict[str, Any]


def tree(text: str, name: str = "x.yaml") -> Node:
    node, faults = parse(name, text)
    assert node is not None, faults
    return node


def parameters(text: str) -> tuple[Parameters, list[Diagnostic]]:
    """The parameters that a PDSL text defines, without `period`, and what is wrong with their types."""
    root = tree(text, "x.pdsl.yaml")
    assert isinstance(root, Mapping)
    assert schema.validate("pdsl", root) == []
    return resolve(build_parameters.build(root, "x.pdsl.yaml"))


def linked(document: Data) -> LinkedParameters:
    """Parameters of a document given as data, which has no faults."""
    made, faults = parameters(flow(document))
    assert not has_errors(faults), (document, faults)
    return LinkedParameters(made)


def values(of: LinkedParameters, data: Data, **more: Any) -> LinkedValues:
    """A values document given as data."""
    root = tree(flow({"parameters": data, **more}), "x.config.yaml")
    assert isinstance(root, Mapping)
    return LinkedValues(build_parameters.build_values(root, "x.config.yaml"), parameters=of)


def as_dict(sections: list[Section]) -> dict[str, str]:
    """The properties of a file, without its sections."""
    return {made.key: made.value for section in sections for made in section.properties}
