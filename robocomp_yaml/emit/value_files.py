"""The files that `compile` generates from values documents: `etc/config`, and legacy files."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING

import msgspec
from msgspec.structs import replace

from robocomp_yaml.addresses.own import adapters
from robocomp_yaml.addresses.own_configuration import own_configuration, own_document, own_values, stated_in, users_keys
from robocomp_yaml.addresses.table import PortTable
from robocomp_yaml.emit import config
from robocomp_yaml.emit.layout import CONFIG
from robocomp_yaml.link.flat_configs import flat_at, flat_config
from robocomp_yaml.link.program import LinkedComponent, LinkedValues, Port, Program
from robocomp_yaml.parameters.writing.properties import legacy_file, properties, property_text
from robocomp_yaml.parameters.writing.sections import CLASSIC, Property, Section, dialect, secret_keys, section_text
from robocomp_yaml.semantics import connections, toml_lines
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.properties import read as properties_of
from robocomp_yaml.source.recall import recalled
from robocomp_yaml.transactions import settings
from robocomp_yaml.transactions.plan import FilePlan

if TYPE_CHECKING:
    from robocomp_yaml.parameters.layers.effective import Effective


def documents_of(linked: LinkedComponent, program: Program) -> list[LinkedValues]:
    """The values documents that configure a component: `etc/config.yaml`, and those beside it with a legacy file of
    their own."""
    folder = program.disk.real(os.path.join(os.path.dirname(linked.component.path), "etc"))
    own = own_values(linked, program)
    beside = {
        real: values
        for real, values in program.values_in(folder).items()
        if values.parameters is not None and values.parameters.component is linked and legacy_file(values)
    }
    if own is not None:  # perhaps a link to another folder
        beside[own_document(linked, program.disk)] = own
    documents = [values for _, values in sorted(beside.items())]
    joined = {str(layer.value) for values in documents for layer in values.document.extends}
    # The first document of a pair is part of the file of the second one.
    return [values for values in documents if os.path.basename(values.document.path) not in joined]


def configs(
    linked: LinkedComponent, program: Program, table: Callable[[], PortTable], root: str = ""
) -> Iterator[FilePlan]:
    """The property files of a component, whose documents have no errors. `table` returns the ports of the workspace,
    and is called only if a document does not set all of them. `root` is the folder of the files, if it is not that of
    the component."""
    documents, memory = documents_of(linked, program), program.memory
    if not (documents and memory.is_lasting):
        yield from _configs(linked, documents, program, table, root)
        return

    def make(disk: Disk) -> tuple[FilePlan, ...]:
        return tuple(_configs(linked, documents, replace(program, disk=disk), table, root))

    part, causes = ("configs", linked.component.path, root), (linked, *documents, *_causes(linked, table()))
    yield from recalled(memory, program.disk, part, causes, make)


def _configs(
    linked: LinkedComponent, documents: list[LinkedValues], program: Program, table: Callable[[], PortTable], root: str
) -> Iterator[FilePlan]:  # fmt: skip
    for values in documents:
        effective, _ = program.effective(values)
        if effective is None:
            continue
        sections = _stated(values, effective, program)
        defaults: list[Section] = []
        if not legacy_file(values) and dialect(values) == CLASSIC:
            defaults = _connections(sections, linked, table, program)
        path = f"etc/{os.path.basename(legacy_file(values))}" if legacy_file(values) else CONFIG
        source, folder = os.path.basename(values.document.path), root or os.path.dirname(linked.component.path)
        stated, name = stated_in(sections), linked.component.name
        part, causes = ("config", values.document.path), (sections, defaults, name)
        sections = [*defaults, *sections]
        text = program.memory.result(part, causes, partial(property_text, sections, name, source))
        if path.endswith(toml_lines.SUFFIX):
            from robocomp_yaml.parameters.writing.toml_text import toml_text  # few configurations are TOML

            text = f"{text.splitlines()[0]}\n\n{toml_text(values, effective)}"
            stated = settings.read(path, text)
        flat = flat_at(os.path.normpath(os.path.join(folder, path)), program.disk)
        beside = _read_before(values, program)
        yield FilePlan(
            path, text, secrets=secret_keys(sections),
            sources=tuple(layer.document.path for layer in values.layers()),
            stated_in=f"etc/{source}", base=section_text(defaults), beside=beside,
            users=tuple(users_keys(flat, stated, settings.read(path, beside))),
        )  # fmt: skip


def _read_before(values: LinkedValues, program: Program) -> str:
    """The legacy files of the layers below a document, as they are: RoboComp's programs read `generic_config` before
    `specific_config`."""
    read = ""
    for layer in values.layers()[:-1]:
        name = legacy_file(layer)
        path = os.path.join(os.path.dirname(layer.document.path), name)
        raw = program.disk.read(path)[0] if name and program.disk.has_file(path) else None
        read += f"{(raw or b'').decode('utf-8', 'replace')}\n"
    return read


def _stated(values: LinkedValues, effective: Effective, program: Program) -> list[Section]:
    """The properties of a values document, which are kept as long as it has the same values."""
    part, causes = ("properties", values.document.path), (*values.causes(), effective)
    return program.memory.result(part, causes, lambda: properties(values, effective, beside=True)[0])


def _connections(
    sections: list[Section], linked: LinkedComponent, table: Callable[[], PortTable], program: Program
) -> list[Section]:  # fmt: skip
    """The endpoints and proxies that the document does not set, with the values of a first `etc/config`: without
    them the component does not start."""
    keys = {made.key for section in sections for made in section.properties}
    if keys >= set(config.needed(linked)):
        return []
    flat = flat_config(os.path.dirname(linked.component.path), program.disk)
    existing, ports = flat.properties if flat is not None else {}, table()

    def by_default() -> list[Section]:
        defaults = config.connections(linked, ports, existing)
        missing = [Property(key, value) for key, value in defaults.items() if key not in keys]
        return [Section("Endpoints and proxies, by default", missing)]

    part, causes = ("connections", linked.component.path), (sections, *_causes(linked, ports), *existing.items())
    return program.memory.result(part, causes, by_default)


def _causes(linked: LinkedComponent, ports: PortTable) -> tuple[object, ...]:
    """What a first `etc/config` depends on, beside the existing one."""
    resolved = ports.resolve(linked).values()
    return (
        linked.component, linked.parameters.parameters,
        *(port.interface for port in linked.ports),
        *(ports.endpoint(linked, name).port for name in adapters(linked)),
        *((one.proxy, one.component and one.component.component, *(other.component for other in one.others))
          for one in resolved),
    )  # fmt: skip


class OwnProperties(msgspec.Struct, frozen=True):
    """A component's own configuration as it starts with it: what `compile` writes from its values document, or its
    `etc/config`. `is_derived`: the file can be missing, or be older."""

    text: str = ""
    values: Mapping[str, str] = {}
    is_derived: bool = False
    secrets: tuple[str, ...] = ()

    def first(self, keys: tuple[str, ...]) -> str:
        """The value of the first of these properties that has one."""
        return connections.first(self.values.get, *keys)

    def proxy(self, port: Port) -> str:
        return self.first(connections.proxy(port.name))


def own_properties(linked: LinkedComponent, program: Program, table: PortTable) -> OwnProperties:
    own = own_configuration(linked, program)
    for plan in configs(linked, program, lambda: table) if own.values is not None else ():
        if plan.path == CONFIG:
            return OwnProperties(plan.text, properties_of(plan.text).values, True, plan.secrets)
    flat = own.flat or flat_config(os.path.dirname(linked.component.path), program.disk)
    return OwnProperties(flat.text, flat.properties) if flat is not None else OwnProperties()
