"""The files that `compile` generates from values documents: `etc/config`, and legacy files."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator

from robocomp_yaml.addresses.table import PortTable
from robocomp_yaml.emit import config
from robocomp_yaml.emit.layout import CONFIG
from robocomp_yaml.link.program import LinkedComponent, LinkedValues, Program
from robocomp_yaml.parameters.writing.properties import (
    CLASSIC,
    Section,
    dialect,
    legacy_file,
    properties,
    property_text,
    secret_keys,
)
from robocomp_yaml.parameters.writing.write import Property
from robocomp_yaml.transactions.plan import FilePlan


def documents_of(linked: LinkedComponent, program: Program) -> list[LinkedValues]:
    """The values documents that configure a component: `etc/config.yaml`, and those beside it with a legacy file of
    their own."""
    folder = os.path.realpath(os.path.join(os.path.dirname(linked.component.path), "etc"))
    documents = [
        values
        for real, values in sorted(program.values.items())
        if os.path.dirname(real) == folder
        and values.parameters is not None
        and values.parameters.component is linked
        and (os.path.basename(real) == "config.yaml" or legacy_file(values))
    ]
    joined = {str(layer.value) for values in documents for layer in values.document.extends}
    # The first document of a pair is part of the file of the second one.
    return [values for values in documents if os.path.basename(values.document.path) not in joined]


def configs(linked: LinkedComponent, program: Program, table: Callable[[], PortTable]) -> Iterator[FilePlan]:
    """The property files of a component, whose documents have no errors. `table` returns the ports of the workspace,
    and is called only if a document does not set all of them."""
    for values in documents_of(linked, program):
        effective, _ = program.effective(values)
        if effective is None:
            continue
        sections, _ = properties(values, effective, beside=True)
        if not legacy_file(values) and dialect(values) == CLASSIC:
            sections = _with_connections(sections, linked, table)
        path = f"etc/{os.path.basename(legacy_file(values))}" if legacy_file(values) else CONFIG
        source = os.path.basename(values.document.path)
        yield FilePlan(
            path, property_text(sections, linked.component.name, source), secrets=secret_keys(sections),
            sources=tuple(layer.document.path for layer in values.layers()),
            stated_in=f"etc/{source}",
        )  # fmt: skip


def _with_connections(
    sections: list[Section], linked: LinkedComponent, table: Callable[[], PortTable]
) -> list[Section]:
    """Adds the endpoints and proxies that the document does not set, with the values of a first `etc/config`: without
    them the component does not start."""
    keys = {made.key for section in sections for made in section.properties}
    if keys >= set(config.needed(linked)):
        return sections
    existing = config.existing(os.path.dirname(linked.component.path))
    defaults = config.connections(linked, table(), existing)
    missing = [Property(key, value) for key, value in defaults.items() if key not in keys]
    return [Section("Endpoints and proxies, by default", missing), *sections]
