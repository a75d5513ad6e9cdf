"""The network that a deployment describes: what runs where, with which command and configuration, and after what.

Everything is resolved: instances, includes and groups are expanded, ports assigned, ports of components connected. What
starts, shows or exports a network reads this, and no document. Paths are absolute; times are in seconds.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.deployment import CONFIG, PLAIN, TLS, TOKEN, ResourceLimits
from robocomp_yaml.model.located import Located
from robocomp_yaml.source.properties import config_option

if TYPE_CHECKING:
    from robocomp_yaml.parameters.editing.settings import ShownSetting

COMPONENT, PROGRAM, ICESTORM = "component", "program", "icestorm"
NEVER, ON_FAILURE, ALWAYS = "no", "on-failure", "always"
SERVER, TASK = "server", "task"
PROXY, TOPIC = "proxy", "topic"
LOOPBACK = "localhost"
PYTHON = "RCYAML_PYTHON"
"""The variable of a process that sets the Python of a component."""
FOLDER = ".rcyaml/deployments"
"""The folder, beside a deployment's document, that contains the deployment's own folder."""
RUNS = ".rcyaml/run"
"""The folder, beside a document, that contains a folder for each process of it that runs in the foreground."""


def is_loopback(address: str) -> bool:
    return address in (LOOPBACK, "::1", "ip6-localhost") or address.startswith("127.")


class SshAccess(msgspec.Struct, frozen=True):
    """How ssh reaches a host, in addition to the operator's own configuration of ssh: the user, the TCP port (0: as
    configured), the private key and the file of known hosts (absolute paths), and the jump host; '' for what is not
    set."""

    user: str = ""
    port: int = 0
    identity: str = ""
    known_hosts: str = ""
    jump: str = ""


class NetworkHost(Located, frozen=True):
    """A machine. `address` is a name or an IP address, LOOPBACK if the document has no hosts. `folders` are folders of
    the operator (absolute paths), with the folders on the host in their stead. `python` is the Python for components,
    and `systemd` the manager of the units of `install` (`user` or `system`); '' for what is not set. `listen` says
    where its processes listen, () for its own address."""

    name: str
    address: str = LOOPBACK
    ssh: SshAccess = SshAccess()
    folders: tuple[tuple[str, str], ...] = ()
    python: str = ""
    systemd: str = ""
    listen: tuple[str, ...] = ()
    span: Span = Span("")

    def there(self, path: str) -> str:
        """The path on the host of what has this absolute path on the operator's machine."""
        for here, there in sorted(self.folders, key=lambda pair: len(pair[0]), reverse=True):
            if path == here or path.startswith(here.rstrip("/") + "/"):
                return os.path.join(there, path[len(here) :].lstrip("/")).rstrip("/") or "/"
        return path


class EnvironmentVariable(msgspec.Struct, frozen=True):
    """A variable of a process's environment: `value`, or the value of the operator's variable `source`, or the text of
    `file` on the process's host. The latter two are read when the process starts, and never written or printed. `file`
    is absolute, or begins with `~/`, the home of the user that runs the process. A line end at its end is ignored."""

    name: str
    value: str = ""
    source: str = ""
    file: str = ""

    @property
    def shown(self) -> str:
        """As in a document; no value of `source` or `file` is shown."""
        if self.file:
            return f"{{file: {self.file}}}"
        return f"{{env: {self.source}}}" if self.source else self.value


class Endpoint(Located, frozen=True):
    """What a process serves: an interface at an address. `identity` is Ice's identity, '' for a plain TCP port.
    `module` is the interface's module, '' if it is unknown. `text` is the value of the adapter's property:
    `tcp -p 10001`. `own_span` is its location in the component's own configuration, if that sets it."""

    interface: str
    identity: str
    port: int
    text: str
    protocol: str = "tcp"
    module: str = ""
    span: Span = Span("")
    own_span: Span = Span("")

    @property
    def key(self) -> str:
        """As the entry's `ports:` names it. The adapter of a subscribed topic ends in Topic, its identity does not."""
        is_of_topic = self.identity != self.interface.lower()
        return self.interface.removesuffix("Topic") if is_of_topic else self.interface


class Readiness(msgspec.Struct, frozen=True):
    """When a process is ready: every proxy of `pings` answers, or something listens on `port`, or `command` exits with
    0, or a line of its output matches the regular expression `log`. Without a condition, a process is ready when it
    runs. `within` is the limit in seconds."""

    within: float = 10.0
    pings: tuple[str, ...] = ()
    port: int | None = None
    command: tuple[str, ...] = ()
    log: str = ""

    @property
    def has_condition(self) -> bool:
        return bool(self.pings or self.port or self.command or self.log)


class RestartRule(msgspec.Struct, frozen=True):
    """What happens when a process ends by itself. `policy` is NEVER, ON_FAILURE or ALWAYS. The first restart waits
    `delay` seconds, each further one twice as long, at most `longest`. After `tries` restarts within `window` seconds
    the process is given up."""

    policy: str = ON_FAILURE
    delay: float = 0.1
    longest: float = 10.0
    tries: int = 5
    window: float = 60.0


class Liveness(msgspec.Struct, frozen=True):
    """How it is checked that a process answers while it runs: `proxy` is asked `every` so many seconds, and must answer
    `within` so many; after `misses` missing answers in a row it is not alive. Then it `restarts`, or that is only
    shown.

    `worker` is the number of seconds for which the worker of a component may show no life: AUTO for ten periods and at
    least 10 s, FOREVER for any time, and for programs that do not describe themselves."""

    proxy: str
    every: float = 5.0
    within: float = 2.0
    misses: int = 2
    restarts: bool = True
    worker: float = -1.0


AUTO, FOREVER = -1.0, 0.0


PEM = "@tls"
"""The end of the name of the file with a process's key and certificates. No process has such a name."""


class ConfigFile(msgspec.Struct, frozen=True):
    """The configuration of one process. `path` is relative to the deployment's own folder, and below `config/`. The
    file may contain secrets: its mode is 0600. `secrets` are the names of its secret properties. `pem` are the key and
    the certificates of a process that talks over TLS, in a file beside it."""

    path: str
    text: str
    secrets: tuple[str, ...] = ()
    pem: str = ""

    @property
    def files(self) -> dict[str, str]:
        """The texts of all files, by their paths."""
        return {self.path: self.text, **({self.pem_path: self.pem} if self.pem else {})}

    @property
    def pem_path(self) -> str:
        return f"{self.path}{PEM}"


class Process(Located, frozen=True, forbid_unknown_fields=True):
    """One process of the network.

    `command` is the program and its arguments, without a shell. The program is an absolute path, or a bare name that is
    resolved in PATH. CONFIG in an argument is replaced by the absolute path of `config`. `after` are the processes that
    must be ready before this one starts; if one of them fails that is also in `optional`, this one starts anyway. Those
    in `awaits` are after it, and it waits for them while it runs: it starts first in a circle. `aliases` are further
    names of the process. When one of the `watched` files changes (executable, code), the process is restarted. `is_ice`
    is False for a program that does not use Ice. `folders` must exist before it starts. `role` is SERVER or TASK, '' if
    the document does not set it; it talks over TLS if it `is_secured`. `settled` are the least seconds that a process
    without a condition must run before it is ready. It does not start if the proxies of `unless` answer before: then
    another one is present.
    """

    name: str
    host: str
    command: tuple[str, ...]
    cwd: str
    kind: str = COMPONENT
    env: tuple[EnvironmentVariable, ...] = ()
    config: ConfigFile | None = None
    endpoints: tuple[Endpoint, ...] = ()
    after: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    awaits: tuple[str, ...] = ()
    ready: Readiness = Readiness()
    restart: RestartRule = RestartRule()
    alive: Liveness | None = None
    limits: ResourceLimits = ResourceLimits()
    watched: tuple[str, ...] = ()
    folders: tuple[str, ...] = ()
    aliases: tuple[str, ...] = ()
    groups: tuple[str, ...] = ()
    enabled: bool = True
    is_ice: bool = True
    role: str = ""
    is_secured: bool = False
    settled: float | None = None
    unless: tuple[str, ...] = ()
    secrets: tuple[str, ...] = ()
    """Names of secret arguments, in addition to names that suggest a secret."""
    component: str = ""
    """The component's name in its CDSL document, '' for other programs."""
    build: str = ""
    """How to build a component whose executable is missing: a hint with commands, relative to the working folder."""
    introspection: str = ""
    """The proxy of the object with which a generated component describes itself, '' for other programs."""
    extra: tuple[tuple[str, object], ...] = ()
    """What only exports need: the entries of `x-rcmanager`, with those of its aliases below `aliases`; and `cwd:` and
    `after:` as the entry spells them."""
    span: Span = Span("")

    @property
    def pem(self) -> str:
        """What a client needs to call it over TLS: a key and certificates; '' if it is plain, or not prepared."""
        return self.config.pem if self.config else ""

    @property
    def listening(self) -> tuple[Endpoint, ...]:
        """Its endpoints, and the TCP port on which it listens when it is ready."""
        port = self.ready.port
        if not port or any(one.port == port and one.protocol != "udp" for one in self.endpoints):
            return self.endpoints
        return (*self.endpoints, Endpoint("", "", port, f"tcp -p {port}", span=self.span))

    @property
    def is_server(self) -> bool:
        """Whether it runs until it is stopped; a task is done when it exits with 0. By default, a process that serves
        something is a server, as is every component."""
        serves = self.kind in (COMPONENT, ICESTORM) or bool(self.endpoints or self.ready.port or self.ready.pings)
        return self.role == SERVER if self.role else serves

    @property
    def restart_policy(self) -> str:
        """The policy for engines, which do not know roles: the end of a server is a failure, whatever its exit code."""
        return ALWAYS if self.is_server and self.restart.policy == ON_FAILURE else self.restart.policy

    def words(self, config: str) -> tuple[str, ...]:
        """The program and its arguments, with the path of its configuration, `config`."""
        program, *arguments = self.command
        if self.kind == ICESTORM and config:
            return program, config_option(config)
        return program, *(word.replace(CONFIG, config) for word in arguments)


class Connection(Located, frozen=True):
    """A line of the graph. With the `kind` PROXY, the process `source` uses the interface that `target` serves, through
    its proxy `port`. With TOPIC, it publishes (`is_out`) or subscribes to `topic` by `port`, and `target` is the
    IceStorm that carries the topic. `target` is '' for an external server, which `proxy` names."""

    source: str
    port: str
    interface: str
    target: str
    kind: str = PROXY
    topic: str = ""
    is_out: bool = False
    proxy: str = ""
    span: Span = Span("")


class Network(msgspec.Struct, frozen=True):
    """A deployment's processes by name, in the document's order. `path` is its document. `folder` is the deployment's
    own folder, with its configurations, logs and state. `order` are the enabled processes in waves: each process is in
    the first wave after the waves of all that it is `after`. `control` is TOKEN or OPEN, `security` TLS or PLAIN."""

    name: str
    path: str
    folder: str
    hosts: Mapping[str, NetworkHost] = {}
    processes: Mapping[str, Process] = {}
    connections: tuple[Connection, ...] = ()
    order: tuple[tuple[str, ...], ...] = ()
    control: str = TOKEN
    security: str = PLAIN
    extra: tuple[tuple[str, object], ...] = ()
    """What only exports need of the document: the entries of its `x-rcmanager`."""
    settings: Mapping[str, Callable[[], list[ShownSetting]]] = {}
    """By process, what returns the values of its configuration with their origin: most runs need none."""

    def settings_of(self, name: str) -> list[ShownSetting]:
        """The values of a process's configuration, with their origin."""
        return self.settings[name]() if name in self.settings else []

    def enabled(self) -> Iterator[Process]:
        return (process for process in self.processes.values() if process.enabled)

    @property
    def is_distributed(self) -> bool:
        return len({process.host for process in self.enabled()}) > 1

    def config_path(self, process: Process) -> str:
        """The absolute path of a process's configuration, '' if it has none."""
        return f"{self.folder}/{process.config.path}" if process.config else ""

    def span_of(self, name: str) -> Span:
        """The location of the process of that name; the document if it has none."""
        process = self.processes.get(name)
        return process.span if process and process.span.file else Span(self.path)

    def span_of_host(self, host: NetworkHost) -> Span:
        """The location of a host; the document if it has none."""
        return host.span if host.span.file else Span(self.path)

    @property
    def is_tls(self) -> bool:
        return self.security == TLS

    def address(self, process: Process) -> str:
        return self.hosts[process.host].address

    def find(self, name: str) -> Process | None:
        """The process of that name or alias, None if it is unknown."""
        aliased = (process for process in self.processes.values() if name in process.aliases)
        return self.processes.get(name) or next(aliased, None)
