"""The first `etc/config` of a component: what its user will want to change, each with a word about it."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence

from robocomp_yaml.emit import ports
from robocomp_yaml.emit.layout import CONFIG
from robocomp_yaml.emit.ports import PortTable, interface_key
from robocomp_yaml.emit.specific.entries import spellings
from robocomp_yaml.link.program import LinkedComponent, Port
from robocomp_yaml.network.port_numbers import default_port
from robocomp_yaml.parameters.defaults import period
from robocomp_yaml.semantics.connections import MANAGER, endpoints, proxy, topic_endpoints
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source.ice_endpoint import IceEndpoint
from robocomp_yaml.source.properties import entry_line, read
from robocomp_yaml.source.regular import text
from robocomp_yaml.transactions.plan import ONCE, FilePlan

_ICE = (
    ("Ice.Warn.Connections", "0", "1: warn when a connection is lost."),
    ("Ice.Trace.Network", "0", "1 to 3: say when connections open and close, and more."),
    ("Ice.Trace.Protocol", "0", "1: show every message."),
    ("Ice.MessageSizeMax", "20004800", "The largest message, in KiB."),
)


def plan(component: LinkedComponent, table: PortTable) -> FilePlan:
    """`etc/config` of a component; `table` has the ports of its workspace."""
    sections = (
        _head(component),
        _offers(component, table),
        _needs(component, table),
        _topics(component),
        _worker(component),
        _middleware(),
    )
    text = "\n".join("".join(f"{line}\n" for line in section) for section in map(list, sections) if section)
    return FilePlan(CONFIG, text, ONCE)


def needed(linked: LinkedComponent) -> list[str]:
    """The keys without which a component finds no other, or is not found itself."""
    keys = [endpoints(name)[0] for name in ports.adapters(linked)]
    keys += [proxy(port.name)[0] for port in linked.requires]
    if linked.publishes or linked.subscribes:
        keys += [MANAGER[0], *(topic_endpoints(port.name)[0] for port in linked.subscribes)]
    return keys


def connections(linked: LinkedComponent, table: PortTable, standing: Mapping[str, str]) -> dict[str, str]:
    """The same with their values, as a first `etc/config` has them. Where no component is known that implements what
    this one requires, what stands in its configuration already is more than a guess."""
    values = read(plan(linked, table).text).values
    found = {key: values[key] for key in needed(linked)}
    for port in linked.requires:
        key = proxy(port.name)[0]
        stands = stated(standing, key)
        if stands is not None and not _others(linked, port, table):
            found[key] = stands
    return found


def stated(properties: Mapping[str, str], key: str) -> str | None:
    """The value that a configuration gives a key under any of its spellings."""
    return next((unquoted(properties[each]) for each in names(key) if properties.get(each)), None)


def names(key: str) -> tuple[str, ...]:
    return key, *sorted(spellings(key))


def standing(folder: str) -> dict[str, str]:
    """The properties of the `etc/config` in a component's folder; none where there is none."""
    return dict(read(text(os.path.join(folder, CONFIG)) or "").values)


def _others(linked: LinkedComponent, port: Port, table: PortTable) -> list[tuple[LinkedComponent, str]]:
    """The other components that implement what one requires."""
    here = ports.document(linked)
    return [one for one in table.implementers.get(interface_key(port), ()) if ports.document(one[0]) != here]


def _head(linked: LinkedComponent) -> Iterator[str]:
    name = linked.component.name
    yield f"# Configuration of {name}: one KEY=VALUE a line, as Ice reads it. rcyaml wrote it once; it is yours now."
    yield f"# The command line overrides it: bin/{name} --period.compute=50 --Ice.Trace.Network=1"


def _offers(linked: LinkedComponent, table: PortTable) -> Iterator[str]:
    yield "# What it offers: where it listens."
    docs = {port.name: port.interface.doc for port in linked.implements}
    for name in ports.adapters(linked):
        doc = docs.get(name, "State, period, properties and orderly stop of every component.")
        yield from _comment(name, doc)
        yield entry_line(endpoints(name)[0], f"tcp -p {table.endpoint(linked, name).port}")


def _needs(linked: LinkedComponent, table: PortTable) -> Iterator[str]:
    if linked.requires:
        yield "# What it needs: where the others listen."
    earlier: dict[tuple[str, str], int] = {}
    for port in linked.requires:
        key = interface_key(port)
        identity = port.interface.name.lower()
        # A second proxy to an interface is for a second component that implements it, where there is one.
        count = earlier[key] = earlier.get(key, -1) + 1
        found = _others(linked, port, table)
        yield from _comment(port.name, port.interface.doc)
        if found:
            other, adapter = found[min(count, len(found) - 1)]
            yield f"# {_implemented(linked, found, other)}"
            endpoint = table.endpoint(other, adapter)
        else:
            yield "# No component of this workspace implements it: set host and port of the one that does."
            endpoint = IceEndpoint(default_port("", port.interface.name))
        where = f"{endpoint.protocol} -h {endpoint.host or 'localhost'} -p {endpoint.port}"
        yield entry_line(proxy(port.name)[0], f"{identity}:{where}")


def _implemented(linked: LinkedComponent, found: Sequence[tuple[LinkedComponent, str]], chosen: LinkedComponent) -> str:
    here = os.path.dirname(linked.component.path) or "."
    text = f"Implemented by {chosen.component.name} ({os.path.relpath(chosen.component.path, here)})"
    also = [other.component.name for other, _ in found if other is not chosen]
    return f"{text}, also by {', '.join(also)}." if also else f"{text}."


def _topics(linked: LinkedComponent) -> Iterator[str]:
    if not (linked.publishes or linked.subscribes):
        return
    yield "# Topics: IceStorm carries them, and its topic manager must be running."
    yield entry_line(MANAGER[0], "IceStorm/TopicManager:default -p 9999")
    for port in linked.subscribes:
        yield from _comment(port.name, port.interface.doc)
        yield "# Port 0: any free one; only IceStorm needs to know it."
        yield entry_line(topic_endpoints(port.name)[0], "tcp -p 0")


def _worker(linked: LinkedComponent) -> Iterator[str]:
    yield "# Milliseconds from one call of compute() to the next."
    yield entry_line("period.compute", str(period(linked.parameters.parameters)))


def _middleware() -> Iterator[str]:
    yield "# Ice, the middleware."
    for key, value, doc in _ICE:
        yield f"# {doc}"
        yield entry_line(key, value)


def _comment(name: str, doc: str) -> Iterator[str]:
    """The first paragraph of a doc text."""
    paragraph = doc.strip().partition("\n\n")[0].splitlines()
    if paragraph:
        yield f"# {name}: {paragraph[0].strip()}"
        yield from (f"# {line.strip()}" for line in paragraph[1:])
