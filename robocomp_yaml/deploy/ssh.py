"""The only client of ssh: OpenSSH, with the user's own keys, agent, known hosts and configuration, and no questions.

Each host has one connection, which all commands of this process share. It is closed when the process ends.
"""

from __future__ import annotations

import atexit
import os
import pwd
import re
import shlex
import shutil
import subprocess
import tempfile
import threading
from collections.abc import Iterator

import msgspec

from robocomp_yaml.network.network import NetworkHost, SshAccess

_CONNECT_WITHIN = 8  # seconds
_IDLE = 60  # seconds after which a connection ends whose process was killed
_LOST = 255  # ssh's own exit code
_SECRET = ("id_rsa", "id_ecdsa", "id_ecdsa_sk", "id_ed25519", "id_ed25519_sk")


class HostFailed(Exception):
    """A host cannot be asked; the text has the reason in the user's words. `hint` suggests what to do, or is ''."""

    def __init__(self, reason: str, hint: str = "") -> None:
        super().__init__(reason)
        self.hint = hint


class SshFailed(HostFailed):
    """A host cannot be reached."""

    def __init__(self, reason: str, hint: str = "") -> None:
        super().__init__(f"ssh: {reason}", hint)


class CommandResult(msgspec.Struct, frozen=True):
    """The result of a command on a host."""

    code: int
    output: bytes
    errors: str

    def reason(self, otherwise: str = "") -> str:
        """The last line of its errors; without one the exit code, behind the words `otherwise`."""
        lines = self.errors.strip().splitlines()
        number = f"exit code {self.code}"
        return lines[-1] if lines else f"{otherwise} ({number})" if otherwise else number


class SshClient:
    """The connections of this process, by host. Methods may be called in several threads."""

    def __init__(self) -> None:
        self._folder = ""
        self._sockets: dict[NetworkHost, str] = {}
        self._failed: dict[NetworkHost, SshFailed] = {}
        self._locks: dict[NetworkHost, threading.Lock] = {}
        self._lock = threading.Lock()

    def run(self, host: NetworkHost, command: list[str], given: bytes = b"", within: float = 60.0) -> CommandResult:
        """Runs a command on a host, with `given` as its input. Raises SshFailed."""
        words = [*self.shell(host), *options(host.ssh), "--", login(host), shlex.join(command)]
        try:
            done = subprocess.run(
                words, input=given, capture_output=True, check=False, timeout=within, start_new_session=True,
                env=_environment(),
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            raise SshFailed(f"no answer within {within:g} s") from None
        errors = done.stderr.decode(errors="replace")
        if done.returncode == _LOST:
            raise self._why(host, errors)
        return CommandResult(done.returncode, done.stdout, errors)

    def shell(self, host: NetworkHost) -> list[str]:
        """The words of ssh up to the address, for a program that runs ssh itself. No word needs quotes. Raises
        SshFailed."""
        with self._lock:
            lock = self._locks.setdefault(host, threading.Lock())
        with lock:
            if host in self._failed:
                raise self._failed[host]
            if host not in self._sockets:
                self._connect(host)
        shared = ["-S", self._sockets[host], "-o", "ControlMaster=no"] if self._sockets[host] else []
        return ["ssh", "-T", "-o", "BatchMode=yes", *shared]

    def _connect(self, host: NetworkHost) -> None:
        with self._lock:
            if not self._folder:
                self._folder = tempfile.mkdtemp(prefix="rcyaml-ssh-", dir="/tmp")  # a short path, for a socket
                atexit.register(self.close)
        socket = f"{self._folder}/{len(self._locks)}-{len(self._sockets)}"
        words = [
            "ssh", "-M", "-S", socket, "-f", "-N", "-T", "-o", f"ControlPersist={_IDLE}", *options(host.ssh),
            "--", login(host),
        ]  # fmt: skip
        # The connection stays in the background with its standard error, which therefore is no pipe.
        with tempfile.TemporaryFile() as errors:
            try:
                done = subprocess.run(
                    words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=errors, check=False,
                    timeout=3 * _CONNECT_WITHIN, start_new_session=True, env=_environment(),
                )  # fmt: skip
            except FileNotFoundError:
                raise self._keep(host, SshFailed("it is not installed here (Debian: openssh-client)")) from None
            except subprocess.TimeoutExpired:
                raise self._keep(host, SshFailed("no answer")) from None
            errors.seek(0)
            if done.returncode == _LOST:
                raise self._keep(host, self._why(host, errors.read().decode(errors="replace")))
        self._sockets[host] = (
            "" if done.returncode else socket
        )  # another program in place of ssh may have no shared one

    def _keep(self, host: NetworkHost, failure: SshFailed) -> SshFailed:
        self._failed[host] = failure
        return failure

    def _why(self, host: NetworkHost, errors: str) -> SshFailed:
        command = typed(host)
        for pattern, reason, hint in _REASONS:
            if found := re.search(pattern, errors, re.IGNORECASE):
                return SshFailed(reason.format(*found.groups()), hint.format(login=command, address=host.address))
        lines = [line.strip() for line in errors.splitlines() if line.strip()]
        return SshFailed(lines[-1] if lines else "the connection was closed", f"`{command} true` shows more")

    def close(self) -> None:
        """Closes all connections."""
        with self._lock:
            sockets, self._sockets, self._failed = self._sockets, {}, {}
            folder, self._folder = self._folder, ""
        for host, socket in ((host, socket) for host, socket in sockets.items() if socket):
            subprocess.run(
                ["ssh", "-S", socket, "-O", "exit", "--", login(host)], capture_output=True, check=False,
                stdin=subprocess.DEVNULL,
            )  # fmt: skip
        if folder:
            shutil.rmtree(folder, ignore_errors=True)


CLIENT = SshClient()


def typed(host: NetworkHost) -> str:
    """The command with which the user reaches a host."""
    access = host.ssh
    words = ["ssh"]
    words += ["-p", str(access.port)] if access.port else []
    words += ["-i", access.identity] if access.identity else []
    words += ["-o", f"UserKnownHostsFile={access.known_hosts}"] if access.known_hosts else []
    words += ["-J", access.jump] if access.jump else []
    return shlex.join([*words, login(host)])


def login(host: NetworkHost) -> str:
    """The host as ssh expects it, with its user."""
    return f"{host.ssh.user}@{host.address}" if host.ssh.user else host.address


def options(access: SshAccess) -> list[str]:
    """The options of ssh for a host. Nothing asks, and nothing of the user's configuration beyond the connection
    itself applies, such as forwarded ports."""
    words = [
        "-o", "BatchMode=yes", "-o", f"ConnectTimeout={_CONNECT_WITHIN}", "-o", "ServerAliveInterval=5",
        "-o", "ServerAliveCountMax=3", "-o", "ClearAllForwardings=yes", "-o", "RemoteCommand=none",
        "-o", "PermitLocalCommand=no", "-o", "ForwardAgent=no", "-o", "ForwardX11=no", "-o", "LogLevel=ERROR",
    ]  # fmt: skip
    words += ["-p", str(access.port)] if access.port else []
    if access.jump:
        words += ["-o", f"ProxyCommand={_through(access)}"]
    return [*words, *_files(access)]


def _files(access: SshAccess) -> Iterator[str]:
    home = os.environ.get("HOME", "")
    if access.identity:
        yield from ("-i", access.identity, "-o", "IdentitiesOnly=yes")
    if access.known_hosts:
        yield from ("-o", f"UserKnownHostsFile={_quoted(access.known_hosts)}")
    if home and not _is_own(home):  # ssh itself ignores HOME
        own = f"{home}/.ssh"
        if os.path.exists(f"{own}/config"):
            yield from ("-F", f"{own}/config")
        if not access.known_hosts:
            yield from ("-o", f"UserKnownHostsFile={_quoted(f'{own}/known_hosts')}")
        for name in _SECRET if not access.identity else ():
            if os.path.exists(f"{own}/{name}"):
                yield from ("-i", f"{own}/{name}")


def _is_own(home: str) -> bool:
    try:
        return os.path.realpath(home) == os.path.realpath(pwd.getpwuid(os.getuid()).pw_dir)
    except KeyError:  # a user without an entry, as in a container
        return False


def _quoted(path: str) -> str:
    """A path in an option of ssh, which splits it at blanks, and replaces `%`."""
    return '"' + path.replace("%", "%%") + '"'


def _through(access: SshAccess) -> str:
    """The command that reaches the jump host, with the same files. `-J` would not pass them on."""
    first, _, last = access.jump.rpartition(",")
    files = [word.replace("%", "%%") for word in _files(access)]
    more = ["-J", first] if first else []
    words = ["ssh", "-o", "BatchMode=yes", "-o", f"ConnectTimeout={_CONNECT_WITHIN}", "-o", "ClearAllForwardings=yes"]
    words += ["-o", "LogLevel=ERROR", *files, *more]
    return f"{shlex.join(words)} -W '[%h]:%p' -- {shlex.quote(f'ssh://{last}')}"


def _environment() -> dict[str, str]:
    return {**os.environ, "LC_ALL": "C", "SSH_ASKPASS_REQUIRE": "never"}


_REASONS = (
    (r"REMOTE HOST IDENTIFICATION HAS CHANGED|host key .* has changed",
     "its key is not the one in your known_hosts: another machine answers at this address, or it was installed again",
     "if it was, `ssh-keygen -R {address}` removes the old key, and `{login}` accepts the new one"),
    (r"Host key verification failed|host key is known",
     "its key is unknown", "connect once with `{login}`, and compare the key"),
    (r"(Load key|identity file) \"?([^\"\n]*?)\"?:? (?:not accessible: )?(.*)",
     "the private key '{1}' cannot be used: {2}", "correct `ssh: {{identity: …}}` of the host"),
    (r"UNPROTECTED PRIVATE KEY FILE|bad permissions", "others can read your private key",
     "`chmod 600` the file of the key"),
    (r"Permission denied|Too many authentication failures|No supported authentication methods",
     "login is not permitted: the host knows none of your keys",
     "`{login}` must work without a password: see ssh-copy-id"),
    (r"Connection refused", "connection refused: no ssh server listens at this port",
     "start one there (Debian: openssh-server), or set `ssh: {{port: …}}` of the host"),
    (r"Could not resolve hostname", "its address cannot be resolved", "correct `address:` of the host"),
    (r"timed out|No route to host|Network is unreachable|Host is down", "no answer",
     "`ping {address}` shows whether it is on"),
    (r"Connection (?:closed|reset) by", "the connection was closed by the host, or by the jump host on the way",
     "`{login} true` shows more"),
)  # fmt: skip
