"""A network of a legacy file before its conversion to a document: nodes, users and comments."""

from __future__ import annotations

import re
from collections.abc import Collection

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.legacy.document import Map, Notes
from robocomp_yaml.legacy.networks.endpoint import NodeEndpoint
from robocomp_yaml.legacy.settings.headers import free
from robocomp_yaml.source.rcremote import NodeCommand

_NO_NAME = re.compile(r"[^A-Za-z0-9_-]+[^A-Za-z0-9_]*")
_LONGEST = 100


class NetworkNode(msgspec.Struct, eq=False):
    """A node of a network. `alias` is its name in the file, `name` that in the document. `command` is None where
    nothing starts it. `interface` is the identity of its endpoint. `after` are the aliases that it depends on.
    `extra` is what only an exporter needs. `by_key` are comments by the document's key."""

    alias: str
    name: str
    span: Span
    command: NodeCommand | None = None
    endpoint: NodeEndpoint | None = None
    endpoint_span: Span = msgspec.field(default_factory=lambda: Span(""))
    interface: str = ""
    after: list[tuple[str, Span, Notes]] = []
    notes: Notes = msgspec.field(default_factory=Notes)
    by_key: dict[str, Notes] = {}
    extra: Map = msgspec.field(default_factory=Map)
    is_shared: bool = False
    """Whether several nodes are the same process."""
    is_only_pinged: bool = False
    """Whether the endpoint is only what the manager asks: the process does not serve it as far as is known."""
    elsewhere: str = ""
    """The host of the endpoint, if it is not that of the process."""


class NetworkDraft(msgspec.Struct, eq=False):
    """A network. `users` are the user names for ssh by host; `extra` is what only an exporter needs."""

    nodes: list[NetworkNode] = []
    users: dict[str, str] = {}
    notes: Notes = msgspec.field(default_factory=Notes)
    extra: Map = msgspec.field(default_factory=Map)


def safe_name(text: str, used: Collection[str] = ()) -> str:
    """Return a name that is valid in documents, files and other programs: of letters, digits, '_' and '-', and not in
    `taken`."""
    bare = _NO_NAME.sub("_", text).strip("_-") or "node"
    bare = bare if bare[0].isalpha() else f"n{bare}"
    bare = bare[:_LONGEST]  # files are named after it
    return free(bare, used)
