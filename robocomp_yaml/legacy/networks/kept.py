"""What only RCManager needs of a network: without what its exporter derives from the document, and once what several
nodes have in common, as a pattern where it repeats a node's command (`killall -9 {program}`)."""

from __future__ import annotations

import posixpath
from collections import Counter
from collections.abc import Mapping, Sequence

import msgspec

from robocomp_yaml.legacy.document import TRUE, DocumentEntry, Map, Raw
from robocomp_yaml.legacy.networks.node import NetworkNode
from robocomp_yaml.model.deployment import CONFIG
from robocomp_yaml.source.rcremote import (
    ALONE,
    ENDPOINT,
    INHERITED,
    LOCAL,
    LOOPBACK,
    OF_COMMAND,
    NodeCommand,
    facts,
    facts_of_endpoint,
    filled,
    pattern_of,
    spelled,
)

_SHARED = ("endpoint", "workingDir", *OF_COMMAND, "radius", "color")
_INSTEAD = {"endpoint": "pinged"}
_FEWEST, _FEW = 3, 2
"""Nodes of a network that keeps something only once, and nodes that have it in common."""


class Derivable(msgspec.Struct, frozen=True):
    """What an exporter derives for a node. `started` is the command of the node's process; `is_elsewhere`, if the entry
    names its folder in the repository, and not that of the other machine. `serves` are the interfaces one of which the
    exporter takes for the endpoint, None for any; `is_one_each`, if each name of the process has one."""

    started: NodeCommand | None = None
    is_elsewhere: bool = False
    serves: Sequence[str] | None = None
    is_one_each: bool = True

    def endpoint_of(self, node: NetworkNode) -> dict[str, str]:
        """The facts of the node's endpoint that the exporter knows."""
        endpoint, command = node.endpoint, node.command
        if endpoint is None or command is None or endpoint.is_storm or node.is_only_pinged or not self.is_one_each:
            return {}
        if not endpoint.identity.islower():
            return {}
        if self.serves is not None and node.interface not in self.serves:
            return {}
        return facts_of_endpoint(endpoint.identity, _host(command), endpoint.port)


NOTHING = Derivable()


def drop_derived(node: NetworkNode, derivable: Derivable) -> None:
    """Drop what an exporter derives from the entry. Something of a node is always kept: an exporter lays out those of
    which the document says nothing."""
    if node.is_only_pinged:
        for extra in node.extra.entries:
            extra.key = "pinged" if extra.key == "endpoint" else extra.key
    command = node.command
    if command is not None and derivable.started is not None and command.tab and not command.in_shell:
        text = None if derivable.is_elsewhere else _spelled(command, derivable.started)
        if _drop(node, "upCommand", text) and command.tab != node.name:
            node.extra.entries.insert(0, DocumentEntry("tab", command.tab))


def _drop(node: NetworkNode, key: str, text: str | None) -> bool:
    """Drop an entry with this text, or with any, and without a comment."""
    entries = node.extra.entries
    for extra in list(entries):
        if extra.key == key and len(entries) > 1 and not extra.notes and (text is None or extra.value == text):
            entries.remove(extra)
            return True
    return False


def _spelled(command: NodeCommand, started: NodeCommand) -> str:
    """Return the command as the exporter spells it, '' where it does not know it."""
    program, *arguments = started.full
    folder = command.folder
    if not posixpath.isabs(folder) or "~" in folder or any(CONFIG in word for word in started.full):
        return ""
    if "/" in program:
        program = posixpath.normpath(posixpath.join(folder, program))
    return spelled(_host(command), command.tab, folder, (program, *arguments))


def _host(command: NodeCommand) -> str:
    return LOCAL if command.host in LOOPBACK else command.host


def inherit(node: NetworkNode, owner: NetworkNode) -> None:
    """Drop what a further name of a process repeats of the first one. If it lacks something, it inherits nothing."""
    entries, inherited = node.extra.entries, [one for one in owner.extra.entries if one.key in INHERITED]
    if {one.key for one in inherited} - {one.key for one in entries}:
        entries.append(DocumentEntry(ALONE, TRUE))
        return
    for one in inherited:
        entries[:] = [
            each for each in entries if each.key != one.key or each.value != one.value or each.notes or len(entries) < 2
        ]  # fmt: skip


def share(nodes: Sequence[NetworkNode], derivable: Mapping[str, Derivable]) -> Map:
    """Return what nodes have in common, and drop it from them, if each node has a value for it; what differs becomes a
    pattern. `derivable` is by the names of nodes."""
    shared = Map()
    kept = [node for node in nodes if node.extra.entries]
    for key in _SHARED:
        values: list[tuple[NetworkNode, DocumentEntry, str | Raw]] = []
        for node in kept:
            one = next((one for one in node.extra.entries if one.key in (key, _INSTEAD.get(key))), None)
            if one is not None and isinstance(one.value, str | Raw):
                values.append((node, one, _pattern(one.value, _facts(node, key, derivable.get(node.name, NOTHING)))))
        plain = Counter(
            pattern for _, one, pattern in values
            if one.key == key and not one.notes and (key != "endpoint" or pattern != one.value)
        )  # fmt: skip
        common, count = plain.most_common(1)[0] if plain else ("", 0)
        if len(values) < len(kept) or len(kept) < _FEWEST or count < _FEW:
            common = ENDPOINT
        if common != ENDPOINT:
            shared.put(key, common)
        for node, one, pattern in values:
            if pattern == common and one.key == key and not one.notes and len(node.extra.entries) > 1:
                node.extra.entries.remove(one)
            else:
                one.value = pattern
    if shared.get("workingDir") is None:
        for node in kept:
            known = derivable.get(node.name, NOTHING)
            if known.started is not None and not known.is_elsewhere:
                _drop(node, "workingDir", known.started.folder)
    return shared


def _facts(node: NetworkNode, key: str, derivable: Derivable) -> dict[str, str]:
    if key == "endpoint":
        return derivable.endpoint_of(node)
    if key not in OF_COMMAND or derivable.started is None:
        return {}
    known = {**facts(derivable.started), "host": _host(derivable.started)}
    if not known["config"] and (derivable.is_elsewhere or key != "configFile"):
        del known["config"]  # a component has one of its own
    return known


def _pattern(value: str | Raw, known: Mapping[str, str]) -> str | Raw:
    """Return the pattern of a value, if it has the same text again."""
    if isinstance(value, Raw) or not known:
        return value
    pattern = pattern_of(value, known)
    return pattern if filled(pattern, known) == value else value
