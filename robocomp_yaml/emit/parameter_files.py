"""What `compile` makes of parameters alone: the schemas of their values, and reference docs."""

from __future__ import annotations

import os
from collections.abc import Iterator

import msgspec

from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.parameters.schema.json_schema import DOCUMENT, EFFECTIVE, document_schema
from robocomp_yaml.transactions.plan import FilePlan

SCHEMA, EFFECTIVE_SCHEMA = "generated/config.schema.json", "generated/effective.schema.json"
DOCS, EXAMPLE = "generated/parameters.md", "generated/example.config.yaml"


def schemas(linked: LinkedComponent) -> Iterator[FilePlan]:
    """The JSON Schemas of a component's values."""
    served = [port.name for port in linked.implements] + [f"{port.name}Topic" for port in linked.subscribes]
    ports = {"endpoints": [*served, "CommonBehavior"], "proxies": [port.name for port in linked.requires]}
    for path, mode in ((SCHEMA, DOCUMENT), (EFFECTIVE_SCHEMA, EFFECTIVE)):
        yield FilePlan(path, _lines(document_schema(linked.parameters.parameters, linked.component.name, ports, mode)))


def _lines(schema: dict[str, object]) -> str:
    """A JSON object with a line for each key: to indent the rest would take ten times as long."""
    rows = (f'  "{key}": {msgspec.json.encode(value).decode()}' for key, value in schema.items())
    return "{\n" + ",\n".join(rows) + "\n}\n"


def docs(linked: LinkedComponent) -> Iterator[FilePlan]:
    """The reference of a component's parameters, and an example of their values."""
    if linked.parameters.document is None:
        return
    from robocomp_yaml.emit.parameter_docs import parameter_docs
    from robocomp_yaml.parameters.examples.new import new_document

    where = os.path.basename(linked.component.path)
    example = new_document(
        linked.parameters.parameters,
        f"../{where}",
        "# An example: every parameter, and what it "
        "may be. The first line of your own document names the schema beside this file.",
        [],
    )
    yield FilePlan(DOCS, parameter_docs(linked))
    yield FilePlan(EXAMPLE, example)
