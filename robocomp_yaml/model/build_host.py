"""Builds the hosts of a deployment from the tree of its document, and what entries have in common with them: variables
and limits. The tree fits the schema."""

from __future__ import annotations

from collections.abc import Iterable

from robocomp_yaml.model import deployment as model
from robocomp_yaml.model.build_interface import as_text, doc, entries, given, integer, required, text, texts
from robocomp_yaml.model.located import Text
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence

_UNITS = {"B": 1, "KB": 10**3, "MB": 10**6, "GB": 10**9, "KiB": 1 << 10, "MiB": 1 << 20, "GiB": 1 << 30}
_CORES = {"on": model.UNLIMITED, "off": 0}


def host(key: Scalar, node: Node) -> model.Host:
    """An entry of `hosts:`."""
    address = required(as_text(node) or as_text(node.get("address")))
    return model.Host(
        key.lexeme,
        address,
        text(node, "user"),
        listen(node),
        doc(node),
        _ssh(node.get("ssh"), key),
        _paths(node.get("path")),
        tuple(variable(name, value) for name, value in entries(node, "env")),
        as_text(node.get("python")),
        given(node, "limits", limits),
        text(node, "systemd"),
        span=key.span,
    )


def listen(node: Node) -> tuple[Text, ...]:
    """Where the processes of a host or an entry listen: () if it is not set."""
    given = node.get("listen")
    if isinstance(given, Sequence):
        return tuple(texts(node, "listen"))
    one = as_text(given)
    return (one,) if one is not None else ()


def _ssh(node: Node | None, key: Scalar) -> model.SshOptions:
    if node is None:
        return model.SshOptions(span=key.span)
    return model.SshOptions(
        text(node, "user"),
        integer(node, "port"),
        text(node, "identity"),
        text(node, "known-hosts"),
        text(node, "jump"),
        span=node.span,
    )


def _paths(node: Node | None) -> tuple[model.Pair, ...]:
    if isinstance(node, Scalar):
        return (model.Pair("", node.lexeme, span=node.span),)
    return pairs(node.items() if isinstance(node, Mapping) else ())


def pairs(entries: Iterable[tuple[Scalar, Node]]) -> tuple[model.Pair, ...]:
    """Keys with their texts."""
    return tuple(
        model.Pair(name.lexeme, value.lexeme, span=value.span, name_span=name.span)
        for name, value in entries
        if isinstance(value, Scalar)
    )


def variable(name: Scalar, value: Node) -> model.Variable:
    """A variable of `env:`."""
    if isinstance(value, Mapping):
        return model.Variable(name.lexeme, source=text(value, "env"), file=text(value, "file"), span=name.span)
    assert isinstance(value, Scalar)
    return model.Variable(name.lexeme, value.lexeme, span=name.span)


def limits(node: Node) -> model.ResourceLimits:
    """The key `limits`."""
    cpu, core = text(node, "cpu"), text(node, "core")
    return model.ResourceLimits(
        _size(text(node, "memory")),
        int(cpu.rstrip(" %")) if cpu else None,
        text(node, "cores") or None,
        integer(node, "nice"),
        integer(node, "realtime"),
        _CORES[core] if core in _CORES else _size(core),
        integer(node, "files"),
    )


def _size(spelled: str) -> int | None:
    """A number of bytes, None for an empty text."""
    if not spelled:
        return None
    number = spelled.rstrip("KMGiB ")
    return round(float(number) * _UNITS[spelled[len(number) :].strip()])
