"""Three hosts for a test: network namespaces joined by a bridge, else three loopback addresses of this machine.

In namespaces, all hosts have the processes and files of this machine, but a network of their own: what one serves, the
others reach only over its address.
"""

from __future__ import annotations

import json
import os
import random
import shlex
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from conftest import ROOT, write_tree
from processes import kill_left, until
from robocomp_yaml.deploy.local import procfs
from seen import agreed, programs, states

NAMES = ("onboard", "head", "arm")
NAME = "Talk"


@dataclass(frozen=True)
class Hosts:
    """`addresses` by the host's name; `prefix` is that of the namespaces, '' where there are none: then `why` says what
    stood against them."""

    addresses: dict[str, str]
    prefix: str = ""
    why: str = ""

    def need_a_network(self, for_what: str) -> None:
        """Skips the test if all hosts are this machine."""
        if not self.prefix:
            pytest.skip(f"there are no network namespaces here, {for_what}: {self.why}")

    def run(self, host: str, command: list[str], **how: Any) -> subprocess.CompletedProcess[str]:
        """The result of a command on a host."""
        how["env"] = self._environment(how.get("env", {}))
        inside = self._inside(host)
        return subprocess.run([*inside, *command], capture_output=True, text=True, check=False, timeout=240, **how)

    def begin(self, host: str, command: list[str], **how: Any) -> subprocess.Popen[str]:
        """A running command on a host, with its output in a pipe."""
        how["env"] = self._environment(how.get("env", {}))
        return subprocess.Popen([*self._inside(host), *command], stdout=subprocess.PIPE, text=True, **how)

    def _inside(self, host: str) -> list[str]:
        return ["ip", "netns", "exec", self.prefix + host] if self.prefix else []

    def _environment(self, more: dict[str, str]) -> dict[str, str]:
        """PATH begins with this Python, with which components start."""
        path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
        return {**os.environ, "PATH": path, **more}

    def link(self, host: str, state: str) -> None:
        """Sets the host's network link `up` or `down`."""
        _ip("-n", f"{self.prefix}net", "link", "set", f"port{NAMES.index(host)}", state)


class NotPermitted(Exception):
    """A step for network namespaces failed; the text is the reason."""


@contextmanager
def three_hosts() -> Iterator[Hosts]:
    prefix = f"rc{os.getpid()}x{random.SystemRandom().randrange(1000)}-"
    try:
        yield _joined(prefix)
    finally:
        _remove(prefix)


def _joined(prefix: str) -> Hosts:
    """Hosts in connected namespaces; if a step fails, loopback addresses."""
    addresses = {name: f"10.99.0.{number}" for number, name in enumerate(NAMES, 1)}
    hosts = Hosts(addresses, prefix)
    try:
        _ip("netns", "add", f"{prefix}net")
        _ip("-n", f"{prefix}net", "link", "add", "bridge", "type", "bridge")
        _ip("-n", f"{prefix}net", "link", "set", "bridge", "up")
        for number, (name, address) in enumerate(addresses.items()):
            space = prefix + name
            _ip("netns", "add", space)
            _ip("-n", space, "link", "add", "eth0", "type", "veth", "peer", f"port{number}", "netns", f"{prefix}net")
            _ip("-n", f"{prefix}net", "link", "set", f"port{number}", "master", "bridge", "up")
            _ip("-n", space, "address", "add", f"{address}/24", "dev", "eth0")
            _ip("-n", space, "link", "set", "eth0", "up")
            _ip("-n", space, "link", "set", "lo", "up")
            _ip("netns", "exec", space, "true")  # which wants mounts of its own as well
    except NotPermitted as why:
        _remove(prefix)
        hosts = Hosts({name: f"127.0.0.{number}" for number, name in enumerate(NAMES, 1)}, why=str(why))
        print(f"three loopback addresses stand for three hosts: {why}")
    return hosts


def _remove(prefix: str) -> None:
    for name in (*NAMES, "net"):
        with suppress(OSError):
            subprocess.run(["ip", "netns", "del", prefix + name], capture_output=True, check=False)


def _ip(*words: str) -> None:
    try:
        done = subprocess.run(["ip", *words], capture_output=True, text=True, check=False)
    except OSError as error:
        raise NotPermitted(f"ip: {error.strerror}") from None
    if done.returncode:
        said = done.stderr.strip().splitlines()
        raise NotPermitted(f"`ip {shlex.join(words)}` fails: {said[-1] if said else done.returncode}")


@contextmanager
def talking_head(
    root: Path, network: str, start_nodes: Callable[[Deployment], None], others: Mapping[str, str] | None = None
) -> Iterator[Deployment]:
    """A network of the example's components, and of those that the files `others` hold, up on three hosts. Where there
    are three, `start_nodes` starts those that no SSH reaches."""
    with three_hosts() as hosts:
        deployment = Deployment(hosts, root)
        shutil.copytree(ROOT / "examples" / "talkinghead", root / "talkinghead")
        write_tree(root, {"talk.ddsl.yaml": network.format(**hosts.addresses), **(others or {})})
        try:
            deployment.rcyaml("migrate", "talkinghead")
            deployment.rcyaml("compile")
            if hosts.prefix:
                start_nodes(deployment)
            deployment.deploy("up")
            yield deployment
        finally:
            deployment.clean_up()


@contextmanager
def talking(root: Path, network: str, others: Mapping[str, str]) -> Iterator[Deployment]:
    """A network of programs, and of the components that the files `others` hold, up on three hosts; it keeps the
    user's state in its own folder."""
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    with three_hosts() as hosts:
        deployment = Deployment(hosts, root, {"XDG_STATE_HOME": f"{root}/own"})
        write_tree(root, {"talk.ddsl.yaml": network.format(**hosts.addresses), **others})
        try:
            if any(name.endswith("cdsl.yaml") for name in others):
                deployment.rcyaml("compile")
            if hosts.prefix:
                deployment.deploy("up", code=1)
                deployment.start_node("head")
                deployment.start_node("arm")
            deployment.deploy("up")
            yield deployment
        finally:
            deployment.clean_up()


@dataclass
class Deployment:
    """The deployment `Talk`, whose commands run on the first of three hosts."""

    hosts: Hosts
    root: Path
    environment: dict[str, str] = field(default_factory=dict)
    there: tuple[str, ...] = ()
    """The deployment's folders on hosts that have one of their own."""

    @property
    def folder(self) -> str:
        return f"{self.root}/.rcyaml/deployments/{NAME}"

    @property
    def state(self) -> Path:
        return Path(self.folder) / "state" / "icegrid"

    def rcyaml(self, *words: str, code: int | None = 0) -> str:
        """The output of a command on the first host. Its exit code must be `code`, if that is not None."""
        done = self.hosts.run(
            "onboard", [sys.executable, "-m", "robocomp_yaml", *words], cwd=self.root, env=self.environment
        )
        assert code in (None, done.returncode), done.stdout + done.stderr
        return done.stdout + done.stderr

    def begin(self, what: str, *words: str) -> subprocess.Popen[str]:
        """A running command of `deploy` on the first host."""
        command = [sys.executable, "-m", "robocomp_yaml", "deploy", what, "talk.ddsl.yaml", *words]
        return self.hosts.begin("onboard", command, cwd=self.root, env=self.environment)

    def deploy(self, what: str, *words: str, code: int | None = 0) -> str:
        return self.rcyaml("deploy", what, "talk.ddsl.yaml", *words, code=code)

    def status(self) -> dict[str, Any]:
        """The status of each process, by its name, which /proc confirms where its host answers."""

        def ask() -> dict[str, Any]:
            said = json.loads(self.deploy("status", "--format", "json", code=None))
            return {one["name"]: one for one in said["processes"]}

        return agreed(self.folder, ask, states, *self.there)

    def pids(self) -> dict[str, int]:
        return {name: one["pid"] for name, one in self.status().items()}

    def until_ready(self) -> dict[str, Any]:
        """The status when all processes are ready."""
        status: dict[str, Any] = {}

        def is_ready() -> bool:
            status.update(self.status())
            return all(one["ready"] for one in status.values())

        until(is_ready, lambda: f"{status}\n{self.logs()}")
        return status

    def logs(self, *names: str) -> str:
        return self.deploy("logs", *names, "-n", "100000")

    def start_node(self, host: str) -> None:
        """Starts nodes by hand as in the hint: bash on the host runs the script."""
        with open(self.state / "hosts" / f"{host}.sh", encoding="utf-8") as script:
            done = self.hosts.run(host, ["bash", "-s"], stdin=script)
        assert done.returncode == 0, done.stderr

    def kill_daemon(self, which: str, *, for_good: bool) -> None:
        """Kills the registry (`registry`) or a node (`nodes/HOST`). `for_good` kills its guard, too, and before that what
        would take the place of the guard."""
        guard = str(self.state / which / "guard")
        helpers = [pid for pid in procfs.marked(self.folder) if procfs.command(pid)[1:3] == [guard, "--watch"]]
        known = [int((self.state / which / file).read_text()) for file in ("pid", "program")]
        if for_good:
            os.kill(known[0], signal.SIGSTOP)  # else it could start a helper again
        for pid in [*helpers, *known] if for_good else known[1:]:
            os.kill(pid, signal.SIGKILL)

    def copies(self, name: str) -> int:
        """The number of processes with the program of this name, without its runner and its log."""
        return len(programs(self.folder, name))

    def clean_up(self) -> None:
        """Kills all processes that are left."""
        kill_left(self.folder)
