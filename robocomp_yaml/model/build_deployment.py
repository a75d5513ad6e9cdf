"""Builds a `Deployment` from the tree of a DDSL document. The tree fits the schema."""

from __future__ import annotations

import math
import shlex
from collections.abc import Callable
from typing import TypeVar

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model import deployment as model
from robocomp_yaml.model.build_host import host, limits, listen, pairs, variable
from robocomp_yaml.model.build_interface import as_text, doc, entries, given, integer, required, span_of, text, texts
from robocomp_yaml.model.duration import seconds
from robocomp_yaml.model.located import Text
from robocomp_yaml.model.port_range import port_range
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence, once

_Made = TypeVar("_Made")


def build(root: Mapping, path: str) -> model.Deployment:
    """Returns the deployment of a document that fits `ddsl.schema.json`; `path` is the document as opened."""
    return model.Deployment(
        name=text(root, "deployment"),
        path=path,
        hosts=tuple(once(host, key, node) for key, node in entries(root, "hosts")),
        services=tuple(once(_storm, key, node) for key, node in entries(root, "services")),
        entries=tuple(once(_entry, key, node) for key, node in entries(root, "components")),
        groups=(
            *(once(_group, key, node) for key, node in entries(root, "groups")),
            *(model.Group(key.lexeme, include=as_text(node), span=key.span) for key, node in entries(root, "include")),
        ),
        includes=tuple(texts(root, "include")),
        extra=_extra(root.get("x-rcmanager")),
        alive=_of(root, "alive", _alive),
        limits=_of(root, "limits", limits),
        doc=doc(root),
        ports=port_range(root),
        control=text(root, "control"),
        security=text(root, "security"),
        control_span=span_of(root, "control"),
        security_span=span_of(root, "security"),
        span=span_of(root, "deployment"),
    )


def _of(root: Mapping, name: str, make: Callable[[Node], _Made]) -> _Made | None:
    """What is made of a node of a document, kept with it; None if it is not set."""
    node = root.get(name)
    return once(_ignoring_key, root.entries[name][0], node, make) if node is not None else None


def _ignoring_key(_: Scalar, node: Node, make: Callable[[Node], _Made]) -> _Made:
    return make(node)


def _text(parent: Node, key: str) -> Text | None:
    return as_text(parent.get(key))


def _storm(key: Scalar, node: Node) -> model.Storm:
    inner = node.get("icestorm")
    if not isinstance(inner, Mapping):
        return model.Storm(key.lexeme, doc=doc(node), span=key.span, port_span=key.span)
    return model.Storm(
        key.lexeme,
        _text(inner, "host"),
        integer(inner, "port"),
        doc(node),
        integer(inner, "publish"),
        inner.data.get("shared") is True,  # type: ignore[attr-defined]
        span=key.span,
        port_span=span_of(inner, "port"),
        publish_span=span_of(inner, "publish"),
    )


def _entry(key: Scalar, node: Node) -> model.Entry:
    assert isinstance(node, Mapping)
    kind = next(kind for kind in (model.COMPONENT, model.PROGRAM, model.PROCESS) if kind in node.entries)
    settings = node.get("set")
    port = node.get("port")
    return model.Entry(
        name=key.lexeme,
        kind=kind,
        target=required(_text(node, kind)),
        executable=_text(node, "executable"),
        args=tuple(texts(node, "args")),
        cwd=_text(node, "cwd"),
        env=tuple(variable(name, value) for name, value in entries(node, "env")),
        host=_text(node, "host"),
        port=None if port is None else _port("", port, port.span),
        ports=tuple(_port(name.lexeme, value, name.span) for name, value in entries(node, "ports")),
        config=_text(node, "config"),
        config_as=_text(node, "config-as"),
        connect=pairs(entries(node, "connect")),
        topics=pairs(entries(node, "topics")),
        settings=settings if isinstance(settings, Mapping) else None,
        restart=given(node, "restart", _restart),
        ready=given(node, "ready", _ready),
        role=text(node, "role"),
        alive=given(node, "alive", _alive),
        listen=listen(node),
        limits=given(node, "limits", limits),
        endpoints=pairs(entries(node, "endpoints")),
        after=tuple(texts(node, "after")),
        enabled=node.data.get("enabled") is not False,  # type: ignore[attr-defined]
        instances=integer(node, "instances"),
        extra=_extra(node.get("x-rcmanager")),
        doc=doc(node),
        span=key.span,
        instances_span=span_of(node, "instances"),
    )


def _port(interface: str, node: Node, name_span: Span) -> model.Number:
    return model.Number(interface, int(node.data), span=node.span, name_span=name_span)  # type: ignore[call-overload]


def _restart(node: Node) -> model.Restart:
    if isinstance(node, Scalar):
        return model.Restart(node.lexeme, span=node.span)
    delay, within = seconds(node.get("delay")), seconds(node.get("within"))
    return model.Restart(text(node, "policy", model.ON_FAILURE), delay, integer(node, "tries"), within, span=node.span)


def _ready(node: Node) -> model.Ready:
    if not isinstance(node, Mapping):
        return model.Ready(seconds(node), span=node.span)
    return model.Ready(
        seconds(node.get("within")),
        integer(node, "port"),
        _command(node.get("command")),
        text(node, "log"),
        text(node, "ping"),
        span=next(
            (node.entries[key][1].span for key in ("port", "ping", "command", "log") if key in node.entries), node.span
        ),
    )


def _alive(node: Node) -> model.Alive:
    if not isinstance(node, Mapping):
        return model.Alive(isinstance(node, Scalar) and node.lexeme == "on", span=node.span)
    worker = node.get("worker")
    is_off = isinstance(worker, Scalar) and worker.lexeme == "off"
    then = text(node, "then")
    return model.Alive(
        None,
        seconds(node.get("every")),
        seconds(node.get("within")),
        integer(node, "misses"),
        then == "restart" if then else None,
        math.inf if is_off else seconds(worker),
        span=node.span,
    )


def _command(node: Node | None) -> tuple[str, ...]:
    if isinstance(node, Scalar):
        try:
            return tuple(shlex.split(node.lexeme))
        except ValueError:  # an unclosed quote is a plain character
            return tuple(node.lexeme.split())
    parts = node.items if isinstance(node, Sequence) else []
    return tuple(part.lexeme for part in parts if isinstance(part, Scalar))


def _extra(node: Node | None) -> tuple[tuple[str, object], ...]:
    return tuple((key.lexeme, _plain_data(value)) for key, value in node.items()) if isinstance(node, Mapping) else ()


def _plain_data(node: Node) -> object:
    """Plain data in which every scalar is its text, so that exporters write numbers as the document spells them."""
    if isinstance(node, Mapping):
        return {key.lexeme: _plain_data(value) for key, value in node.items()}
    if isinstance(node, Sequence):
        return [_plain_data(item) for item in node.items]
    return node.lexeme if isinstance(node, Scalar) else None


def _group(key: Scalar, node: Node) -> model.Group:
    return model.Group(
        name=key.lexeme,
        members=tuple(texts(node, "components")),
        include=_text(node, "include"),
        facade=_text(node, "as"),
        exposed=tuple(_exposed(name, value) for name, value in entries(node, "expose")),
        host=_text(node, "host"),
        doc=doc(node),
        span=key.span,
    )


def _exposed(name: Scalar, node: Node) -> model.Exposed:
    member = required(as_text(node) or _text(node, "member"))
    if not isinstance(node, Mapping):
        return model.Exposed(name.lexeme, member, span=name.span)
    rate = node.get("rate")
    return model.Exposed(
        name.lexeme,
        member,
        rate=float(rate.data) if rate else None,  # type: ignore[arg-type]
        allow=tuple(texts(node, "allow")) if "allow" in node.entries else None,
        span=name.span,
    )
