"""The network that a deployment describes: what runs where, with which command and configuration, and after what.

Everything is resolved: instances are counted out, includes and groups expanded, ports given, connections found. What
starts, shows or exports a network reads this and no document. Paths are absolute; times are seconds.
"""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.deployment import CONFIG
from robocomp_yaml.model.located import Located

COMPONENT, PROGRAM, ICESTORM = "component", "program", "icestorm"
NEVER, ON_FAILURE, ALWAYS = "no", "on-failure", "always"
PROXY, TOPIC = "proxy", "topic"
LOOPBACK = "localhost"
FOLDER = ".rcyaml/deployments"
"""Where deployments have their own folders, beside their documents."""


def is_loopback(address: str) -> bool:
    return address in (LOOPBACK, "::1", "ip6-localhost") or address.startswith("127.")


class Host(Located, frozen=True):
    """A machine; `address` is a name or an IP address, LOOPBACK where the document names no hosts. `user` is for ssh,
    '' for the caller's own."""

    name: str
    address: str = LOOPBACK
    user: str = ""
    span: Span = Span("")


class Variable(msgspec.Struct, frozen=True):
    """A variable of a process's environment: `value`, or that of the caller's variable `source`, or the text of `file`
    on the process's host. Both are read when the process starts, and never written or printed. `file` is absolute, or
    begins with `~/`, the home of whoever runs the process; one line end at its end does not count."""

    name: str
    value: str = ""
    source: str = ""
    file: str = ""

    @property
    def shown(self) -> str:
        """As a document says it."""
        if self.file:
            return f"{{file: {self.file}}}"
        return f"{{env: {self.source}}}" if self.source else self.value


class Endpoint(Located, frozen=True):
    """What a process serves: an interface at an address. `identity` is Ice's identity, '' for a plain port; `module`
    is the interface's module, '' where it is not known. `text` is the adapter's own spelling: `tcp -p 10001`."""

    interface: str
    identity: str
    port: int
    text: str
    protocol: str = "tcp"
    module: str = ""
    span: Span = Span("")


class Readiness(msgspec.Struct, frozen=True):
    """What must hold before those that depend on a process start: every proxy of `pings` answers, or something listens
    on `port`, or `command` exits with 0, or a line of output matches the regular expression `log`. With none of these
    a process is ready once it runs. `within` are seconds."""

    within: float = 10.0
    pings: tuple[str, ...] = ()
    port: int | None = None
    command: tuple[str, ...] = ()
    log: str = ""

    @property
    def is_asked(self) -> bool:
        return bool(self.pings or self.port or self.command or self.log)


class Restart(msgspec.Struct, frozen=True):
    """What happens when a process ends by itself: `policy` is NEVER, ON_FAILURE or ALWAYS. Restarts wait `delay`
    seconds, twice as long each time up to `longest`, and stop after `tries` within `window` seconds."""

    policy: str = ON_FAILURE
    delay: float = 0.1
    longest: float = 10.0
    tries: int = 5
    window: float = 60.0


class ConfigFile(msgspec.Struct, frozen=True):
    """A file written for one process in the deployment's own folder, below `config/`; `path` is relative to that
    folder. It may hold what nobody else should read: its mode is 0600. `secrets` are the properties in it that are not
    to be shown."""

    path: str
    text: str
    secrets: tuple[str, ...] = ()


class Process(Located, frozen=True, forbid_unknown_fields=True):
    """One process of the network. `command` is the program and its arguments (no shell ever sees them), its first an
    absolute path, or a bare name that PATH finds; the placeholder CONFIG in an argument stands for the absolute path
    of `config`. `after` are the processes that must be ready before; where one of these that is `optional` fails, this
    one starts all the same. `aliases` are further names of the same process. `watched` are the files whose change is a
    reason to restart it (its executable, code and configuration). `is_ice` is False for a program that knows nothing of
    Ice. `folders` are to be there before it starts.
    """

    name: str
    host: str
    command: tuple[str, ...]
    cwd: str
    kind: str = COMPONENT
    env: tuple[Variable, ...] = ()
    config: ConfigFile | None = None
    endpoints: tuple[Endpoint, ...] = ()
    after: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    ready: Readiness = Readiness()
    restart: Restart = Restart()
    watched: tuple[str, ...] = ()
    folders: tuple[str, ...] = ()
    aliases: tuple[str, ...] = ()
    groups: tuple[str, ...] = ()
    enabled: bool = True
    is_ice: bool = True
    secrets: tuple[str, ...] = ()
    """Names that stand for secrets in its arguments, beside those that say so themselves."""
    component: str = ""
    """The component's name in its CDSL, '' for other programs."""
    build: str = ""
    """What brings about a component's executable where there is none: a hint, as its user would type it from here."""
    extra: tuple[tuple[str, object], ...] = ()
    """What only an exporter needs: the entries of `x-rcmanager`; below `aliases`, those of its other names."""
    span: Span = Span("")

    def words(self, config: str) -> tuple[str, ...]:
        """The program and its arguments; `config` is where its configuration will be."""
        program, *arguments = self.command
        return program, *(word.replace(CONFIG, config) for word in arguments)


class Connection(Located, frozen=True):
    """A line of the graph: the process `source` uses the interface that `target` serves, through its proxy `port`
    (`kind` PROXY); or it publishes (`is_out`) or is subscribed to the topic `topic` by `port`, and `target` is the
    IceStorm that carries it (TOPIC). `target` is '' for something outside, which `proxy` names."""

    source: str
    port: str
    interface: str
    target: str
    kind: str = PROXY
    topic: str = ""
    is_out: bool = False
    proxy: str = ""
    span: Span = Span("")


class Network(msgspec.Struct):
    """A deployment's processes by name, in the document's order. `path` is its document; `folder` is the deployment's
    own folder, where all that is derived, logged and remembered of it lies. `order` are the enabled processes in
    waves: each process stands in the first wave behind all that it is `after`."""

    name: str
    path: str
    folder: str
    hosts: dict[str, Host] = {}
    processes: dict[str, Process] = {}
    connections: list[Connection] = []
    order: list[tuple[str, ...]] = []
    extra: tuple[tuple[str, object], ...] = ()
    """What only an exporter needs of the document as such: the entries of its `x-rcmanager`."""

    def enabled(self) -> Iterator[Process]:
        return (process for process in self.processes.values() if process.enabled)

    @property
    def is_distributed(self) -> bool:
        return len({process.host for process in self.enabled()}) > 1

    def config_path(self, process: Process) -> str:
        """The absolute path of a process's configuration; '' without one."""
        return f"{self.folder}/{process.config.path}" if process.config else ""

    def span_of(self, name: str) -> Span:
        """Where the document has the process of that name; the document where it has none."""
        process = self.processes.get(name)
        return process.span if process and process.span.file else Span(self.path)

    def address(self, process: Process) -> str:
        return self.hosts[process.host].address

    def find(self, name: str) -> Process | None:
        """The process of that name or alias."""
        found = self.processes.get(name)
        return found or next((process for process in self.processes.values() if name in process.aliases), None)
