"""What a push would do on one host: compares the files here with those there."""

from __future__ import annotations

import os

import msgspec

from robocomp_yaml.deploy.push.host_files import (
    BROUGHT,
    SEEN,
    HostFiles,
    PushedFile,
    digest_of,
    is_native,
    is_same_kind,
    kind_in_words,
    start_of,
)
from robocomp_yaml.deploy.ssh import typed
from robocomp_yaml.diag.codes import deploying as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.network.network import Network, NetworkHost


class HostPush(msgspec.Struct):
    """What is done on a host; paths are those there. `send` are files with their paths here; `replaced` are those of
    them that somebody else changed or put there: they are kept elsewhere. `delete` are files that a push brought and
    nothing needs any more; `changed` would be such files, but were changed there, and stay. `built` are programs that
    were built there, for another kind of machine. `entries` is the new list."""

    host: NetworkHost
    send: dict[str, str] = {}
    replaced: list[str] = []
    delete: list[str] = []
    changed: list[str] = []
    built: list[str] = []
    unchanged: int = 0
    size: int = 0
    entries: dict[str, PushedFile] = {}
    there: HostFiles = msgspec.field(default_factory=HostFiles)

    @property
    def kept(self) -> str:
        """The folder on the host of files that were replaced."""
        return f"{self.there.list.rpartition('/pushed/')[0]}/replaced"

    @property
    def is_empty(self) -> bool:
        return not (self.send or self.delete)


def plan(
    network: Network, host: NetworkHost, files: dict[str, tuple[str, ...]], there: HostFiles, *, whole: bool
) -> tuple[HostPush, list[Diagnostic]]:  # fmt: skip
    """The push of these files, by their paths here with the names of the processes that need them. Without `whole`,
    these are not all files of the host, and nothing is deleted."""
    found, faults = HostPush(host, there=there), list[Diagnostic]()
    for here, names in files.items():
        path, digest = host.there(here), digest_of(here)
        start = start_of(here) if here in programs(network, names) else ""
        if start and is_native(start) and not is_same_kind(start, there.machine):
            own = there.programs.get(path, "")
            if is_native(own) and is_same_kind(own, there.machine):
                found.built.append(path)
            else:
                faults += [_other_kind(network, host, name, start, there.machine) for name in names]
            continue
        if not digest:
            if path not in there.digests:
                faults += [_missing(network, name, here) for name in names]
            elif here in programs(network, names):
                found.built.append(path)
            continue
        was, now = there.pushed.get(path), there.digests.get(path, "")
        is_runnable = path in there.runnable or here not in programs(network, names) or not os.access(here, os.X_OK)
        if now == digest and is_runnable:
            found.unchanged += 1
            how = was.how if was else BROUGHT if path in there.others else SEEN
        else:
            found.send[path] = here
            found.size += os.path.getsize(here)
            how = BROUGHT
            is_ours = (was and was.digest == now) or path in there.others
            if now and now != digest and not is_ours:
                found.replaced.append(path)
        found.entries[path] = PushedFile(how, digest, path)
    for path, one in there.pushed.items():
        if path in found.entries or path in found.built:
            continue
        if not whole:
            found.entries[path] = one
        elif one.how == BROUGHT and path in there.digests and path not in there.others:
            (found.delete if there.digests[path] == one.digest else found.changed).append(path)
    return found, faults


def programs(network: Network, names: tuple[str, ...]) -> set[str]:
    return {network.processes[name].command[0] for name in names}


def _other_kind(network: Network, host: NetworkHost, name: str, start: str, machine: str) -> Diagnostic:
    process = network.processes[name]
    where = host.there(os.path.dirname(network.path))
    how = f"; there, {process.build}" if process.build else ""
    reason = f"its program is for {kind_in_words(start)}, and the host '{host.name}' is {kind_in_words(machine)}"
    hint = f"build it on that host (`{typed(host)}`, folder {where}){how}"
    return codes.CANNOT.at(process.span, name=name, what="pushed", reason=reason, hint=hint)


def _missing(network: Network, name: str, path: str) -> Diagnostic:
    process = network.processes[name]
    return codes.CANNOT.at(
        process.span, name=name, what="pushed", reason=f"the file '{path}' is missing", hint=process.build
    )  # fmt: skip
