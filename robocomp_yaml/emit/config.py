"""The first `etc/config` of a component: the properties that users change, each with a comment."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence

from robocomp_yaml.addresses.own import MANAGER as DEFAULT_MANAGER
from robocomp_yaml.addresses.own import adapters
from robocomp_yaml.addresses.table import PortTable
from robocomp_yaml.emit.layout import CONFIG
from robocomp_yaml.emit.specific.config_merge import spellings
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.parameters.defaults import period
from robocomp_yaml.semantics.connections import ICE_DEFAULTS, MANAGER, endpoints, proxy, topic_endpoints
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source.properties import FIRST_HEAD, entry_line, read
from robocomp_yaml.source.regular import text
from robocomp_yaml.transactions.plan import ONCE, FilePlan

_ICE = (
    ("Ice.Warn.Connections", "0", "1: warn when a connection is lost."),
    ("Ice.Trace.Network", "0", "1 to 3: log opened and closed connections, and more."),
    ("Ice.Trace.Protocol", "0", "1: log every message."),
    ("Ice.MessageSizeMax", ICE_DEFAULTS["Ice.MessageSizeMax"], "The size limit of messages, in KiB."),
)


def plan(component: LinkedComponent, table: PortTable) -> FilePlan:
    """The plan of a component's first `etc/config`; `table` has the ports of its workspace. Where the user changed a
    port, it is the one that rcyaml wrote: the plan is what edits are compared with."""
    return FilePlan(CONFIG, _text(component, table, table.first_port), ONCE)


def _text(component: LinkedComponent, table: PortTable, port_of: Callable[[LinkedComponent, str], int]) -> str:
    compute = period(component.parameters.parameters)
    ice = [line for key, value, doc in _ICE for line in (f"# {doc}", f"# {entry_line(key, value)}")]
    sections = (
        _head(component),
        _endpoints(component, port_of),
        _proxies(component, table),
        _topics(component),
        ["# Milliseconds from one call of compute() to the next.", entry_line("period.compute", str(compute))],
        ["# Ice, the middleware. To change a default, remove the # before its name.", *ice],
    )
    return "\n".join("".join(f"{line}\n" for line in section) for section in map(list, sections) if section)


def needed(linked: LinkedComponent) -> list[str]:
    """The keys without which a component cannot reach others, or cannot be reached."""
    keys = [endpoints(name)[0] for name in adapters(linked)]
    keys += [proxy(port.name)[0] for port in linked.requires]
    if linked.publishes or linked.subscribes:
        keys += [MANAGER[0], *(topic_endpoints(port.name)[0] for port in linked.subscribes)]
    return keys


def connections(linked: LinkedComponent, table: PortTable, existing: Mapping[str, str]) -> dict[str, str]:
    """The needed keys with the values of a first `etc/config`. A proxy of the existing configuration is kept if no
    known component implements the interface."""
    defaults = read(_text(linked, table, lambda linked, name: table.endpoint(linked, name).port)).values
    values, resolved = {key: defaults[key] for key in needed(linked)}, table.resolve(linked)
    for port in linked.requires:
        key = proxy(port.name)[0]
        value = stated(existing, key)
        if value is not None and resolved[port.name].component is None:
            values[key] = value
    return values


def stated(properties: Mapping[str, str], key: str) -> str | None:
    """The value of a key in a configuration, under any of its spellings; None if it is not set."""
    if not properties:
        return None
    return next((unquoted(properties[each]) for each in names(key) if properties.get(each)), None)


def names(key: str) -> tuple[str, ...]:
    """All spellings of a key, its own first."""
    return key, *sorted(spellings(key))


def existing(folder: str) -> dict[str, str]:
    """The properties of the `etc/config` in a component's folder; empty if it does not exist."""
    return dict(read(text(os.path.join(folder, CONFIG)) or "").values)


def _head(linked: LinkedComponent) -> Iterator[str]:
    name = linked.component.name
    yield f"# Configuration of {name}: one KEY=VALUE per line, as Ice reads it. {FIRST_HEAD}"
    yield f"# The command line overrides it: bin/{name} --period.compute=50 --Ice.Trace.Network=1"


def _endpoints(linked: LinkedComponent, port_of: Callable[[LinkedComponent, str], int]) -> Iterator[str]:
    yield "# The addresses on which this component listens."
    docs = {port.name: port.interface.doc for port in linked.implements}
    for name in adapters(linked):
        doc = docs.get(name, "State, period, properties and orderly stop of every component.")
        yield from _comment(name, doc)
        yield entry_line(endpoints(name)[0], f"tcp -p {port_of(linked, name)}")


def _proxies(linked: LinkedComponent, table: PortTable) -> Iterator[str]:
    if linked.requires:
        yield "# The addresses of the components that it requires."
    resolved = table.resolve(linked)
    for port in linked.requires:
        found = resolved[port.name]
        yield from _comment(port.name, port.interface.doc)
        if found.component is not None:
            yield f"# {_implemented(linked, found.others, found.component)}"
        else:
            yield "# No component of this workspace implements it: set host and port of one that does."
        yield entry_line(proxy(port.name)[0], found.proxy)


def _implemented(linked: LinkedComponent, others: Sequence[LinkedComponent], chosen: LinkedComponent) -> str:
    folder = os.path.dirname(linked.component.path) or "."
    text = f"Implemented by {chosen.component.name} ({os.path.relpath(chosen.component.path, folder)})"
    also = [other.component.name for other in others if other is not chosen]
    return f"{text}, also by {', '.join(also)}." if also else f"{text}."


def _topics(linked: LinkedComponent) -> Iterator[str]:
    if not (linked.publishes or linked.subscribes):
        return
    yield "# Topics: IceStorm carries them, and its topic manager must be running."
    yield entry_line(MANAGER[0], DEFAULT_MANAGER)
    for port in linked.subscribes:
        yield from _comment(port.name, port.interface.doc)
        yield "# Port 0: any free port, which only IceStorm has to know."
        yield entry_line(topic_endpoints(port.name)[0], "tcp -p 0")


def _comment(name: str, doc: str) -> Iterator[str]:
    """The first paragraph of a documentation text."""
    paragraph = doc.strip().partition("\n\n")[0].splitlines()
    if paragraph:
        yield f"# {name}: {paragraph[0].strip()}"
        yield from (f"# {line.strip()}" for line in paragraph[1:])
