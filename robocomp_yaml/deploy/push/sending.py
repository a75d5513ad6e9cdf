"""Pushes files to hosts with rsync, over the connections of the one client of ssh."""

from __future__ import annotations

import os
import shlex
import subprocess
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from datetime import UTC, datetime

from robocomp_yaml.deploy.push import host_files
from robocomp_yaml.deploy.push.host_files import PushedFile
from robocomp_yaml.deploy.push.planned import HostPush
from robocomp_yaml.deploy.ssh import CLIENT, HostFailed, login
from robocomp_yaml.grouping import grouped
from robocomp_yaml.network.network import NetworkHost

_PARTIAL = ".rcyaml-partial"

Sent = Callable[[str, str], None]
"""Is called with the name of a host and the path of a file that was sent."""


def carry_out(push: HostPush, report: Sent) -> None:
    """Raises HostFailed. Then the next push continues: the list has all files that can be there."""
    host, there = push.host, push.there
    if push.send:
        coming = {path: PushedFile(host_files.BROUGHT, "-", path) for path in push.send}
        own = [_base(host, here) for here in push.send.values()]
        folders = sorted({host.there(base) if base else "" for base in own} - {""} or {"/"})
        before = {**coming, **there.pushed}
        host_files.keep(host, there.list, before.values(), folders)
        kept = f"{push.kept}/{os.path.basename(there.list)}"
        _send(push, push.replaced, f"{kept}/{datetime.now(UTC):%Y-%m-%dT%H-%M-%S.%f}", report)
        _send(push, [path for path in push.send if path not in set(push.replaced)], "", report)
    if push.send or push.delete or push.entries != there.pushed:
        gone = [(above, path) for path in push.delete for above in [_above(host, path)]]
        host_files.keep(host, there.list, push.entries.values(), (), gone)


def _send(push: HostPush, paths: Iterable[str], backup: str, report: Sent) -> None:
    by_base = grouped((_base(push.host, push.send[path]), path) for path in paths)
    for base, chosen in by_base.items():
        local = base or "/"
        target = push.host.there(base) if base else "/"
        names = {os.path.relpath(push.send[path], local): path for path in chosen}
        for name in _rsync(push.host, local, target, names, backup):
            if name in names:
                report(push.host.name, names[name])


def _base(host: NetworkHost, here: str) -> str:
    """The folder here that stands for one there, '' for a path that is the same there."""
    found = [folder for folder, _ in host.folders if here.startswith(folder.rstrip("/") + "/")]
    return max(found, key=len, default="")


def _above(host: NetworkHost, path: str) -> str:
    """The folder of the host above which no empty folder is deleted."""
    found = [folder for _, folder in host.folders if path.startswith(folder.rstrip("/") + "/")]
    return max(found, key=len, default=os.path.dirname(os.path.dirname(path)))


def _rsync(host: NetworkHost, base: str, target: str, names: Mapping[str, str], backup: str) -> Iterator[str]:
    """The names of the files that rsync has sent. Raises HostFailed."""
    shell = shlex.join(CLIENT.shell(host))
    address = login(NetworkHost(host.name, f"[{host.address}]" if ":" in host.address else host.address, host.ssh))
    words = [
        "rsync", "--perms", "--times", "--copy-links", "--ignore-times", "--no-implied-dirs", "--omit-dir-times",
        "--from0", "--files-from=-", f"--partial-dir={_PARTIAL}", "-s", "--timeout=60", "--out-format=%n", "-e", shell,
    ]  # fmt: skip
    words += ["--backup", f"--backup-dir={backup}"] if backup else []
    words += ["--", f"{base.rstrip('/')}/", f"{address}:{target.rstrip('/')}/"]
    with tempfile.TemporaryFile() as said_wrong, subprocess.Popen(
        words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=said_wrong, start_new_session=True
    ) as rsync:  # fmt: skip
        assert rsync.stdin and rsync.stdout
        try:
            rsync.stdin.write("".join(f"{name}\0" for name in names).encode(errors="surrogateescape"))
            rsync.stdin.close()
            for line in rsync.stdout:
                yield os.fsdecode(line.rstrip(b"\n"))
        except BaseException:
            rsync.terminate()  # it keeps what it has of a file
            raise
        rsync.wait()
        said_wrong.seek(0)
        errors = said_wrong.read().decode(errors="replace").splitlines()
    if rsync.returncode:
        said = [line.strip() for line in errors if line.strip() and not line.startswith("rsync error:")]
        raise HostFailed(said[0] if said else f"rsync ended with exit code {rsync.returncode}")
