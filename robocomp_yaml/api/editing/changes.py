"""The changes that a person makes in a network or a component: small and typed.

Every interface to rcyaml makes the same changes.

`entry` is a name below `components:`, as written (`mouth{i}`). JSON has the name of the change as `change`:
`{"change": "connect", "entry": "speech", "port": "Mouth", "to": "mouth"}`.
"""

from __future__ import annotations

from typing import Any, ClassVar

import msgspec


class _Tagged(msgspec.Struct, frozen=True, tag_field="change", forbid_unknown_fields=True):
    """A change; its name in JSON is its tag."""


class Connect(_Tagged, frozen=True, tag="connect"):
    """A required interface is served by `to`: an entry, one of its interfaces, a group, or a proxy."""

    entry: str
    port: str
    to: str


class Disconnect(_Tagged, frozen=True, tag="disconnect"):
    """The document does not set the server of a required interface any more."""

    entry: str
    port: str


class NameTopic(_Tagged, frozen=True, tag="topic"):
    """A published or subscribed topic has the name `to` in this network; '': its own."""

    entry: str
    port: str
    to: str = ""


class MoveEntry(_Tagged, frozen=True, tag="move"):
    """An entry runs on another host."""

    entry: str
    host: str


class AddHost(_Tagged, frozen=True, tag="add-host"):
    """`path` is the folder of the deployment there; `user` and what follows `path` are for ssh."""

    name: str
    address: str
    user: str = ""
    path: str = ""
    port: int | None = None
    identity: str = ""
    known_hosts: str = ""
    jump: str = ""


class RemoveHost(_Tagged, frozen=True, tag="remove-host"):
    name: str


class GroupEntries(_Tagged, frozen=True, tag="group"):
    """Entries, or other groups, become members of a group, which is made if it is missing."""

    group: str
    members: tuple[str, ...]


class UngroupEntries(_Tagged, frozen=True, tag="ungroup"):
    """Members leave a group; without members, the group is removed. Its members stay."""

    group: str
    members: tuple[str, ...] = ()


class AddEntry(_Tagged, frozen=True, tag="add"):
    """A component, by the path of its document or folder relative to the working folder, or a program with its
    arguments."""

    entry: str
    component: str = ""
    program: str = ""
    args: tuple[str, ...] = ()
    host: str = ""


class RemoveEntry(_Tagged, frozen=True, tag="remove"):
    """An entry is removed, with what this document connects to it."""

    entry: str


class RenameEntry(_Tagged, frozen=True, tag="rename"):
    """An entry or a group has another name, wherever this document names it."""

    entry: str
    name: str


class SetParameter(_Tagged, frozen=True, tag="set"):
    """A parameter has this value in this network; null: that of the component's own configuration."""

    entry: str
    parameter: str
    value: Any


class SetPort(_Tagged, frozen=True, tag="port"):
    """The TCP port of an interface, or of the first one if `interface` is ''; null: a derived one."""

    entry: str
    number: int | None
    interface: str = ""


class SetInstances(_Tagged, frozen=True, tag="instances"):
    entry: str
    count: int


class StartAfter(_Tagged, frozen=True, tag="after"):
    """An entry starts when `needed` (entries, services, groups) are ready."""

    entry: str
    needed: tuple[str, ...]


class StartIndependently(_Tagged, frozen=True, tag="not-after"):
    entry: str
    needed: tuple[str, ...]


class AddNew(_Tagged, frozen=True, tag="add-new"):
    """A new component is written, as `rcyaml new component` does it, and added as an entry. `component` is its name."""

    entry: str
    component: str
    language: str = ""
    implements: tuple[str, ...] = ()
    requires: tuple[str, ...] = ()
    publishes: tuple[str, ...] = ()
    subscribes: tuple[str, ...] = ()
    host: str = ""


class _PortChange(_Tagged, frozen=True):
    """A change of a list (`key`) of a component: it has one or several interfaces more, which are imported, or less.
    `component` is the component's name, its folder or its document; '': the document that is changed."""

    interface: str | tuple[str, ...]
    component: str = ""
    key: ClassVar[str]
    adds: ClassVar[bool] = True

    @property
    def interfaces(self) -> tuple[str, ...]:
        return (self.interface,) if isinstance(self.interface, str) else self.interface


class Implement(_PortChange, frozen=True, tag="implement"):
    key = "implements"


class Unimplement(_PortChange, frozen=True, tag="unimplement"):
    key, adds = "implements", False


class Require(_PortChange, frozen=True, tag="require"):
    key = "requires"


class Unrequire(_PortChange, frozen=True, tag="unrequire"):
    key, adds = "requires", False


class Publish(_PortChange, frozen=True, tag="publish"):
    key = "publishes"


class Unpublish(_PortChange, frozen=True, tag="unpublish"):
    key, adds = "publishes", False


class Subscribe(_PortChange, frozen=True, tag="subscribe"):
    key = "subscribes"


class Unsubscribe(_PortChange, frozen=True, tag="unsubscribe"):
    key, adds = "subscribes", False


DeploymentChange = (
    Connect | Disconnect | NameTopic | MoveEntry | AddHost | RemoveHost | GroupEntries | UngroupEntries | AddEntry
    | AddNew | RemoveEntry | RenameEntry | SetParameter | SetPort | SetInstances | StartAfter | StartIndependently
)  # fmt: skip
ComponentChange = (
    Implement | Unimplement | Require | Unrequire | Publish | Unpublish | Subscribe | Unsubscribe
)  # fmt: skip
DocumentChange = DeploymentChange | ComponentChange


def from_json(data: object) -> DocumentChange:
    """The change that JSON data describes. Raises ValueError with a message for users."""
    try:
        made: DocumentChange = msgspec.convert(data, DocumentChange)
    except msgspec.ValidationError as error:
        raise ValueError(str(error)) from None
    return made


def name_of(change: DocumentChange) -> str:
    return str(type(change).__struct_config__.tag)
