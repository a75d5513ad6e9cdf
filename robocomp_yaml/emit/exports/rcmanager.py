"""RCManager's XML: nodes with their dependences, commands, and positions in its graph.

What a migrated document keeps under `x-rcmanager:` is written unchanged, as far as it still matches the network.
"""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Iterator, Mapping, Sequence

from robocomp_yaml.emit.exports import _unwritable
from robocomp_yaml.emit.exports._commands import file_name, limited
from robocomp_yaml.emit.xml_text import HEAD, element
from robocomp_yaml.model.deployment import CONFIG, ResourceLimits
from robocomp_yaml.network.network import ICESTORM, LOOPBACK, Network, Process
from robocomp_yaml.source import rcremote
from robocomp_yaml.source.ice_proxy import proxy_at
from robocomp_yaml.source.rcremote import ENDPOINT, facts_of_endpoint, filled

ATTRIBUTES = {
    "workingDir": "path", "upCommand": "command", "downCommand": "command", "configFile": "path",
    "xpos": "value", "ypos": "value", "radius": "value", "color": "value",
}  # fmt: skip
"""The elements of a node with one value, and the attribute of the value; in RCManager's order."""

_OWN = ("alias", "endpoint", "pinged", "dependence", "aliases", "tab", "at", "cwd", "after", rcremote.ALONE)
GENERAL = {
    "editor": {"path": "kate", "dock": "false"},
    "timeouts": {"fixed": "1000.0", "blink": "300.0"},
    "clicks": {"switch": "2.0", "interval": "400.0"},
    "graph": {"alpha": "80.0", "active": "true", "scale": "200.0"},
    "graphTiming": {"idletime": "1000.0", "focustime": "500.0", "fasttime": "10.0", "fastperiod": "2000.0"},
    "simulation": {"hookes": "0.07", "springlength": "0.5", "friction": "0.4", "step": "0.5", "fieldforce": "20000.0"},
}
_SPACE = 100
_EVERY_COMPONENT = "CommonBehavior"
_SPECIAL = re.compile(r"[][\\.*+?^${}()|]")
_LOCAL = (LOOPBACK, "127.0.0.1", "::1")

Kept = Mapping[str, object]


def export(network: Network) -> dict[str, str]:
    exporter = _Exporter(network)
    lines = "\n".join(element("rcmanager", exporter.attributes(), exporter.children()))
    return {f"{file_name(network.name)}.xml": f"{HEAD}{lines}\n"}


class _Exporter:
    def __init__(self, network: Network) -> None:
        self.network = network
        self.kept = dict(network.extra)
        self.nodes = _mapping(self.kept.pop("nodes", None))
        self.each = _mapping(self.kept.pop("each", None))
        self.here = _text(self.kept.pop(LOOPBACK, ""))
        self.owners = {name: process.name for process in network.processes.values()
                       for name in (process.name, *process.aliases)}  # fmt: skip
        self.aliases = {name: _text(self.of(name).get("alias"), name) for name in self.owners}
        self.by_alias = {alias: name for name, alias in reversed(self.aliases.items())}  # the first one of its name

    def of(self, name: str) -> Kept:
        """What the document keeps of a node, and of each one of which it keeps something."""
        kept = self.kept_of(name)
        if not kept:
            return kept
        at = kept.get("at")
        place = dict(zip(("xpos", "ypos"), map(_text, at), strict=False)) if isinstance(at, list) else {}
        each = {key: value for key, value in self.each.items() if key != "endpoint"}
        merged = {**each, **self.inherited(name, kept), **place, **kept}
        known = self.facts(name)
        return merged | {key: filled(_text(merged[key]), known) for key in rcremote.OF_COMMAND if key in merged}

    def inherited(self, name: str, kept: Kept) -> Kept:
        """What a further name of a process has as the first one."""
        process = self.network.processes.get(self.owners.get(name, ""))
        if process is None or name == process.name or name in self.nodes or rcremote.ALONE in kept:
            return {}
        return {key: value for key, value in process.extra if key in rcremote.INHERITED}

    def facts(self, name: str) -> dict[str, str]:
        """What the texts of a node may repeat of its command."""
        process = self.network.processes.get(self.owners.get(name, ""))
        if process is None or process.kind == ICESTORM:
            return {}
        config = self.network.config_path(process)
        known = rcremote.facts(rcremote.of_words(self.address(process), self.folder(process), process.words(config)))
        return {**known, "config": config} if config else known

    def kept_of(self, name: str) -> Kept:
        process = self.network.processes.get(self.owners.get(name, ""))
        if process is None or name in self.nodes:
            return _mapping(self.nodes.get(name))
        extra = dict(process.extra)
        return extra if name == process.name else _mapping(_mapping(extra.get("aliases")).get(name))

    def attributes(self) -> dict[str, str]:
        return {key: value for key, value in self.kept.items() if isinstance(value, str)}

    def children(self) -> Iterator[str]:
        elements = {key: value for key, value in self.kept.items() if not isinstance(value, str)}
        for key, value in (elements or {"generalInformation": GENERAL}).items():
            yield from _generic(key, value)
        for process in self.network.processes.values():
            with _unwritable.of(process):
                if process.env:
                    names = ", ".join(one.name for one in process.env)
                    _unwritable.note(f"RCManager sets no variables for its commands: {names}")
                for number, name in enumerate((process.name, *process.aliases)):
                    yield from self.node(process, name, number)
        for name in self.nodes:
            if name not in self.owners:
                kept = self.of(name)
                yield from _node(_text(kept.get("alias"), name), _text(kept.get("endpoint")), _texts(kept), kept)

    def node(self, process: Process, name: str, number: int) -> Iterator[str]:
        """The node of a name of a process; `number` counts the names of a process from 0."""
        kept = self.of(name)
        made: dict[str, object] = {"workingDir": self.folder(process), "upCommand": self.command(process, name, kept)}
        if not kept:
            config = self.network.config_path(process)
            made |= {"downCommand": f"pkill -f {shlex.quote(self.pattern(process, config))}", "configFile": config}
            made |= {**self.position(process, number), "radius": "10.0", "color": "#AAAAAA"}
        unchanged = {key: value for key, value in kept.items() if key not in _OWN}
        if "upCommand" in unchanged and not self.still_starts(process, _text(unchanged["upCommand"])):
            del unchanged["upCommand"]
        yield from _node(self.aliases[name], self.endpoint(process, kept, number),
                         self.dependences(process, name, kept), {**made, **unchanged})  # fmt: skip

    def address(self, process: Process) -> str:
        """The address of a process; localhost, if the migrated file called it so."""
        address = self.network.address(process)
        return LOOPBACK if address == self.here else address

    def endpoint(self, process: Process, kept: Kept, number: int) -> str:
        if "pinged" in kept:
            return _text(kept.get("pinged"))
        text = _text(kept.get("endpoint"))
        proxy = proxy_at(text)
        ports = {endpoint.port for endpoint in process.endpoints}
        if (
            "endpoint" in kept
            and "{port}" not in text
            and (proxy is None or not {one.port for one in proxy.endpoints} - ports)
        ):
            return text
        known = [endpoint for endpoint in process.endpoints if endpoint.identity]
        if process.component:  # what it is for, before what all components have, and what it is told
            known.sort(key=lambda one: (one.identity != one.interface.lower(), one.interface == _EVERY_COMPONENT))
        selected = known[number : number + 1]
        pattern = text if "{port}" in text else _text(self.each.get("endpoint")) if kept else ""
        return "".join(
            filled(pattern or ENDPOINT.replace("tcp", one.protocol), facts_of_endpoint(one.identity, address, one.port))
            for address in [self.address(process)]
            for one in selected
        )

    def dependences(self, process: Process, name: str, kept: Kept) -> list[str]:
        """The dependences that the document keeps, and the others of the process. Of those of a migrated node,
        the document names all: RCManager's graph does not have what connections imply."""
        texts = _texts(kept)
        if name != process.name:
            return texts
        listed = [alias for other in (name, *process.aliases) for alias in _texts(self.of(other))]
        meant = {self.owners[self.by_alias[alias]] for alias in listed if alias in self.by_alias}
        named = dict(process.extra).get("after")
        others = [_text(other) for other in named] if isinstance(named, list) else process.after
        aliases = {alias: self.owners[other] for other in others for alias in [self.aliases.get(other)] if alias}
        return [*texts, *(alias for alias, other in aliases.items() if other not in meant)]

    def command(self, process: Process, name: str, kept: Kept) -> str:
        words = limited(process, process.words(self.network.config_path(process)), "RCManager")
        folder = self.folder(process)
        return rcremote.spelled(self.address(process), _text(kept.get("tab")) or file_name(name), folder, words)

    def folder(self, process: Process) -> str:
        """The working folder of a process, as the document spells it where that is the same."""
        spelled = _text(dict(process.extra).get("cwd"))
        return spelled if os.path.normpath(spelled) == process.cwd else process.cwd

    def pattern(self, process: Process, config: str) -> str:
        """A regular expression that matches the command line of this process only: it contains the process's own
        configuration, or all words if there is none."""
        text = config or " ".join(process.command)
        return _SPECIAL.sub(r"\\\g<0>", text) + ("( |$)" if config else "$")

    def still_starts(self, process: Process, command: str) -> bool:
        """Whether a kept command starts the same program as the process, on the same host and in the same folder."""
        if process.kind == ICESTORM:
            return True
        if process.limits != ResourceLimits():
            return False
        try:
            words = shlex.split(command)
        except ValueError:
            words = command.split()
        if words[:1] == ["rcremote"]:
            host, folder, words = words[1], words[3], words[4:]
            local = (host in _LOCAL) == (self.address(process) in _LOCAL)
            if not local or (host not in _LOCAL and host != self.address(process)):
                return False
            if self.path(os.path.dirname(self.network.path), folder) != process.cwd:
                return False
        if process.command[:2] == ("sh", "-c"):
            return command.rstrip().endswith(process.command[2])
        return len(words) == len(process.command) and all(
            CONFIG in word or text == word or self.path(process.cwd, text) == word
            for text, word in zip(words, process.command, strict=True)
        )

    def path(self, folder: str, text: str) -> str:
        return os.path.abspath(os.path.join(folder, os.path.expanduser(text)))

    def position(self, process: Process, number: int) -> dict[str, object]:
        """The position of a node: a row for each wave of processes that start together, the first one at the bottom."""
        for row, wave in enumerate(self.network.order):
            if process.name in wave:
                column = wave.index(process.name) - (len(wave) - 1) / 2
                return {"xpos": f"{column * _SPACE + number * _SPACE / 4:.1f}", "ypos": f"{-row * _SPACE:.1f}"}
        return {"xpos": f"{number * _SPACE / 4:.1f}", "ypos": f"{_SPACE:.1f}"}


def _node(alias: str, endpoint: str, dependences: Sequence[str], kept: Kept) -> Iterator[str]:
    inside = [line for other in dependences for line in element("dependence", {"alias": other})]
    rest = {key: value for key, value in kept.items() if key not in (*ATTRIBUTES, *_OWN)}
    for name, attribute in ATTRIBUTES.items():
        value = kept.get(name)
        if isinstance(value, str):
            inside += element(name, {attribute: value})
        elif value is not None:
            inside += _generic(name, value)
    attributes = {"alias": alias, "endpoint": endpoint}
    for key, value in rest.items():
        if isinstance(value, str):
            attributes[key] = value
        else:
            inside += _generic(key, value)
    yield from element("node", attributes, inside)


def _generic(name: str, value: object) -> list[str]:
    """An element whose texts are its attributes. A list is several elements with the same name."""
    if isinstance(value, list):
        return [line for item in value for line in _generic(name, item)]
    body = _mapping(value)
    attributes = {key: item for key, item in body.items() if isinstance(item, str)}
    below = [line for key, item in body.items() if not isinstance(item, str) for line in _generic(key, item)]
    return element(name, attributes, below)


def _mapping(value: object) -> Kept:
    return value if isinstance(value, dict) else {}


def _text(value: object, otherwise: str = "") -> str:
    return value if isinstance(value, str) else otherwise


def _texts(kept: Kept) -> list[str]:
    value = kept.get("dependence")
    return [_text(item) for item in value] if isinstance(value, list) else []
