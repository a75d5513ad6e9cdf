"""The DDSL model: which components and programs make a network, where they run and how they are connected.

Names and paths are as written; `{i}` still stands in the strings of an entry that has instances.
"""

from __future__ import annotations

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.located import Spanned, Text
from robocomp_yaml.source.tree import Mapping

COMPONENT, PROGRAM, PROCESS = "component", "program", "process"
NEVER, ON_FAILURE, ALWAYS = "no", "on-failure", "always"
ARGUMENT = "argument"
INDEX = "{i}"
CONFIG = "{config}"
"""In an argument: the path of the process's configuration."""


class Host(Spanned, frozen=True):
    """An entry of `hosts:`. `user` is for ssh, '' for the caller's own."""

    name: str
    address: Text
    user: str = ""
    doc: str = ""


class Storm(Spanned, frozen=True):
    """An entry of `services:`: an IceStorm. `port` is None where none is given."""

    name: str
    host: Text | None = None
    port: int | None = None
    doc: str = ""
    port_span: Span = Span("")


class Variable(Spanned, frozen=True):
    """A variable of the environment: `value`, or the caller's variable `source`, or the text of `file`."""

    name: str
    value: str = ""
    source: str = ""
    file: str = ""


class Number(Spanned, frozen=True):
    """A port: that of the interface `name`, which is '' for `port:`."""

    name: str
    number: int
    name_span: Span = Span("")


class Pair(Spanned, frozen=True):
    """A key and its text: of `connect`, `topics`, `endpoints` or `expose`. `span` is the text's place."""

    name: str
    text: str
    name_span: Span = Span("")


class Ready(Spanned, frozen=True):
    """When others may start: `port` listens, `command` exits with 0, a line of output matches `log`; with none of
    these, what is served answers a ping. `within` are seconds, None where nothing is said."""

    within: float | None = None
    port: int | None = None
    command: tuple[str, ...] = ()
    log: str = ""


class Restart(Spanned, frozen=True):
    """`policy` is NEVER, ON_FAILURE or ALWAYS; the others are None where nothing is said. Times are seconds."""

    policy: str = ON_FAILURE
    delay: float | None = None
    tries: int | None = None
    within: float | None = None


class Entry(Spanned, frozen=True):
    """An entry of `components:`. `kind` is the key that says what it is: COMPONENT, PROGRAM, or PROCESS (a second name
    of another entry's process); `target` is that key's value. `program` of a component is its `executable:`.

    `settings` is the tree of `set:`. `config_as` is ARGUMENT or an option such as `--Ice.Config`. `instances` is None
    where the key does not stand. `extra` is the data of `x-rcmanager:`, every scalar as spelled.
    """

    name: str
    kind: str
    target: Text
    executable: Text | None = None
    args: tuple[Text, ...] = ()
    cwd: Text | None = None
    env: tuple[Variable, ...] = ()
    host: Text | None = None
    port: Number | None = None
    ports: tuple[Number, ...] = ()
    config: Text | None = None
    config_as: Text | None = None
    connect: tuple[Pair, ...] = ()
    topics: tuple[Pair, ...] = ()
    settings: Mapping | None = None
    restart: Restart | None = None
    ready: Ready | None = None
    endpoints: tuple[Pair, ...] = ()
    after: tuple[Text, ...] = ()
    enabled: bool = True
    instances: int | None = None
    extra: tuple[tuple[str, object], ...] = ()
    doc: str = ""
    instances_span: Span = Span("")


class Exposed(Spanned, frozen=True):
    """An entry of a group's `expose:`: `name` is served by a member (`member.Interface` where its interface's name
    differs). A `rate` (calls a second, at most) or `allow` (the methods that may be called; None: all) asks for a
    proxy in between."""

    name: str
    member: Text
    rate: float | None = None
    allow: tuple[Text, ...] | None = None


class Group(Spanned, frozen=True):
    """An entry of `groups:`, or of `include:` in its form with names. `members` are names of this document, and
    `include` another deployment's document; `facade` is the CDSL of `as:`. `host` is for members that name none."""

    name: str
    members: tuple[Text, ...] = ()
    include: Text | None = None
    facade: Text | None = None
    exposed: tuple[Exposed, ...] = ()
    host: Text | None = None
    doc: str = ""

    @property
    def is_closed(self) -> bool:
        """Whether what is outside reaches the members only through the group."""
        return self.facade is not None or bool(self.exposed)


class Deployment(Spanned, frozen=True):
    """One DDSL document. `includes` are those without a name: what they hold counts as if it stood here. `extra` is the
    plain data of `x-rcmanager:`."""

    name: str
    path: str
    hosts: tuple[Host, ...] = ()
    services: tuple[Storm, ...] = ()
    entries: tuple[Entry, ...] = ()
    groups: tuple[Group, ...] = ()
    includes: tuple[Text, ...] = ()
    extra: tuple[tuple[str, object], ...] = ()
    doc: str = ""

    @property
    def all_includes(self) -> tuple[Text, ...]:
        """Those of groups, too."""
        return (*self.includes, *(group.include for group in self.groups if group.include))
