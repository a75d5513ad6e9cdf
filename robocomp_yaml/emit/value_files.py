"""What `compile` makes of values: `etc/config`, and the legacy files that they are carried over to."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator

from robocomp_yaml.emit import config
from robocomp_yaml.emit.layout import CONFIG
from robocomp_yaml.emit.ports import PortTable
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
    """The values documents that a component is configured from: `etc/config.yaml`, and those beside it that are
    written to a legacy file of their own."""
    folder = os.path.realpath(os.path.join(os.path.dirname(linked.component.path), "etc"))
    found = [
        values
        for real, values in sorted(program.values.items())
        if os.path.dirname(real) == folder
        and values.parameters is not None
        and values.parameters.component is linked
        and (os.path.basename(real) == "config.yaml" or legacy_file(values))
    ]
    joined = {str(layer.value) for values in found for layer in values.document.extends}
    # The first half of a pair is joined into the other half's file.
    return [values for values in found if os.path.basename(values.document.path) not in joined]


def configs(linked: LinkedComponent, program: Program, table: Callable[[], PortTable]) -> Iterator[FilePlan]:
    """The property files of a component; the documents have been found right. `table` has the ports of the workspace,
    asked for where a document leaves some open."""
    for values in documents_of(linked, program):
        found, _ = program.effective(values)
        if found is None:
            continue
        sections, _ = properties(values, found, beside=True)
        if not legacy_file(values) and dialect(values) == CLASSIC:
            sections = _with_connections(sections, linked, table)
        path = f"etc/{os.path.basename(legacy_file(values))}" if legacy_file(values) else CONFIG
        source = os.path.basename(values.document.path)
        yield FilePlan(
            path, property_text(sections, linked.component.name, source), secrets=secret_keys(sections),
            sources=tuple(layer.document.path for layer in values.layers()),
            stated_in=f"{CONFIG}.yaml" if path == CONFIG else "",
        )  # fmt: skip


def _with_connections(
    sections: list[Section], linked: LinkedComponent, table: Callable[[], PortTable]
) -> list[Section]:
    """The endpoints and proxies that the document does not give, as a first `etc/config` would have them: without them
    nothing would start."""
    given = {made.key for section in sections for made in section.properties}
    if given >= set(config.needed(linked)):
        return sections
    there = config.standing(os.path.dirname(linked.component.path))
    missing = [
        Property(key, value) for key, value in config.connections(linked, table(), there).items() if key not in given
    ]
    return [Section("Where this component and the others are, by default", missing), *sections]
