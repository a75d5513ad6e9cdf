"""What a legacy file says of a network, before it becomes a document: nodes, and what goes with them."""

from __future__ import annotations

import re
from collections.abc import Collection

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.legacy.document import Map, Notes
from robocomp_yaml.legacy.networks.command import NodeCommand
from robocomp_yaml.legacy.networks.endpoint import NodeEndpoint
from robocomp_yaml.legacy.settings.headers import free

_NO_NAME = re.compile(r"[^A-Za-z0-9_-]+[^A-Za-z0-9_]*")
_LONGEST = 100


class NetworkNode(msgspec.Struct, eq=False):
    """`alias` is its name in the file, `name` that in the document. `command` is None where nothing starts it.
    `interface` is what its endpoint is called. `after` are the aliases that it depends on. `extra` is what only an
    exporter needs. `by_key` are comments by the key that they belong to."""

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
    """Whether its process has several names."""


class NetworkDraft(msgspec.Struct, eq=False):
    """`users` are the names for ssh by host; `extra` is what only an exporter needs of the network as such."""

    nodes: list[NetworkNode] = []
    users: dict[str, str] = {}
    notes: Notes = msgspec.field(default_factory=Notes)
    extra: Map = msgspec.field(default_factory=Map)


def safe_name(text: str, taken: Collection[str] = ()) -> str:
    """A name that documents, files and other programs take: letters, digits, '_' and '-', and none of `taken`."""
    bare = _NO_NAME.sub("_", text).strip("_-") or "node"
    bare = bare if bare[0].isalpha() else f"n{bare}"
    bare = bare[:_LONGEST]  # files are called after it
    return free(bare, taken)
