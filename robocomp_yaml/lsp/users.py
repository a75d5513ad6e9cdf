"""Who uses a name, and the values of a parameter: for hover and lenses."""

from __future__ import annotations

import os
from collections.abc import Iterator

from robocomp_yaml.api.completing import values
from robocomp_yaml.diag.listing import some
from robocomp_yaml.link.program import LinkedComponent, Program
from robocomp_yaml.model.component import LISTS
from robocomp_yaml.naming import names as kinds
from robocomp_yaml.naming.names import DefinedName, Key
from robocomp_yaml.naming.of_interfaces import key_of
from robocomp_yaml.parameters.editing.show import shown
from robocomp_yaml.parameters.words import for_editors
from robocomp_yaml.pipeline import Analysis

_MOST = 8
_IN_WORDS = {
    "implements": "implemented by", "requires": "required by", "publishes": "published by",
    "subscribes": "subscribed to by",
}  # fmt: skip


def of_interface(program: Program, key: Key) -> Iterator[tuple[str, list[str]]]:
    """The components that use an interface, by what they do with it."""
    for list_ in LISTS:
        users = [
            linked.component.name
            for linked in program.components.values()
            if any(key_of(port.scope, port.interface) == key for port in getattr(linked, list_))
        ]
        if users:
            yield list_, sorted(users)


def of_component(analysis: Analysis, path: str) -> list[str]:
    """The processes of a component, with the deployments."""
    found = []
    for linked in analysis.program.deployments.values():
        if not linked.is_included:
            found += [
                f"{one.name} ({os.path.basename(linked.deployment.path)})"
                for one in linked.instances.values()
                if one.component is not None and one.component.component.path == path
            ]
    return found


def described(analysis: Analysis, one: DefinedName) -> Iterator[str]:
    """What hover says of a name, beside its definition."""
    program = analysis.program
    if one.kind in (kinds.INTERFACE, kinds.TOPIC):
        for list_, users in of_interface(program, one.key):
            yield f"{_IN_WORDS[list_]} {some(users, _MOST)}"
    elif one.kind == kinds.COMPONENT:
        if users := of_component(analysis, one.key[1]):
            yield f"processes: {some(users, _MOST)}"
    elif one.kind == kinds.HOST:
        if users := _on_host(analysis, one):
            yield f"processes: {some(users, _MOST)}"
    elif one.kind == kinds.PARAMETER:
        yield from _of_parameter(analysis, one)
    elif one.kind == kinds.ENTRY:
        yield from _of_entry(analysis, one)


def _on_host(analysis: Analysis, one: DefinedName) -> list[str]:
    return [
        instance.name
        for linked in analysis.program.deployments.values()
        if linked.deployment.path == one.key[1]
        for instance in linked.instances.values()
        if instance.host is not None and instance.host.name == one.name
    ]


def _of_parameter(analysis: Analysis, one: DefinedName) -> Iterator[str]:
    program = analysis.program
    linked = next((p for p in program.parameters.values() if p.document and p.document.path == one.key[1]), None)
    if linked is None:
        return
    member = values.member_at(linked.parameters.root, one.key[2:])
    if member is not None:
        yield for_editors(member)
    rows = list(_values_in_documents(program, one)) + list(_values_in_networks(analysis, linked.component, one))
    if rows:
        more = [f"- and {len(rows) - _MOST} more"] if len(rows) > _MOST else []
        yield "\n".join(["effective values:", *(f"- {row}" for row in rows[:_MOST]), *more])


def _values_in_documents(program: Program, one: DefinedName) -> Iterator[str]:
    path = ".".join(one.key[2:])
    for linked in program.values.values():
        own = linked.parameters
        if own is None or own.document is None or own.document.path != one.key[1]:
            continue
        found = program.effective(linked)[0]
        for row in shown(found, reveal=False) if found is not None else ():
            if row.path == path:
                where = os.path.relpath(linked.document.path, os.path.dirname(one.key[1]))
                text = f"{row.text} {row.unit}".strip()
                yield f"`{text}` in {where}{' (default)' if row.node is None else ''}"


def _values_in_networks(analysis: Analysis, component: LinkedComponent | None, one: DefinedName) -> Iterator[str]:
    path = ".".join(one.key[2:])
    for real, linked in analysis.program.deployments.items():
        network = analysis.networks.get(real)
        if network is None or linked.is_included or component is None:
            continue
        for instance in linked.instances.values():
            if instance.component is component and instance.name in network.processes:
                for setting in network.settings_of(instance.name):
                    if setting.key == path:
                        yield f"`{setting.value}` for {instance.name} ({os.path.basename(linked.deployment.path)})"


def _of_entry(analysis: Analysis, one: DefinedName) -> Iterator[str]:
    for real, linked in analysis.program.deployments.items():
        network = analysis.networks.get(real)
        if network is None or linked.deployment.path != one.key[1]:
            continue
        for instance in linked.instances.values():
            process = network.processes.get(instance.name)
            if (
                process is None
                or instance.document is not linked.deployment
                or instance.entry.span.line != one.span.line
            ):
                continue
            lines = [f"- serves {each.interface}: `{each.text}`" for each in process.endpoints]
            lines += [f"- {text}" for text in connected(analysis, real, instance.name)]
            if lines:
                yield "\n".join([f"{instance.name}:", *lines[: 2 * _MOST]])
            if instance.number is not None:
                return  # the others are alike


def connected(analysis: Analysis, real: str, process: str) -> Iterator[str]:
    """The connections of a process, in words."""
    for one in analysis.networks[real].connections:
        if one.source == process and one.kind == "topic":
            yield f"{'publishes' if one.is_out else 'subscribes to'} {one.topic}"
        elif one.source == process:
            yield f"{one.port} → {one.target or one.proxy}"
