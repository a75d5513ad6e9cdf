"""What a host has of a deployment's files, and its list of those that were pushed.

The list is a file of the host's user, below `$XDG_STATE_HOME/rcyaml/pushed`. An entry is how a file came there, its
digest, and its path. A file was either brought, or it was there already with the same content: only files that were
brought are ever deleted.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence

import msgspec

from robocomp_yaml import resources
from robocomp_yaml.deploy.here import folder_on
from robocomp_yaml.deploy.probe import run_on
from robocomp_yaml.deploy.ssh import HostFailed
from robocomp_yaml.network.network import Network, NetworkHost
from robocomp_yaml.source.digest import digest
from robocomp_yaml.source.regular import content, regular

BROUGHT, SEEN = "B", "S"
_ELF = "7f454c46"
_KINDS = {
    "3e00": "x86-64", "b700": "ARM of 64 bits (aarch64)", "2800": "ARM of 32 bits", "0300": "x86 of 32 bits",
    "f300": "RISC-V", "1500": "PowerPC",
}  # fmt: skip


class PushedFile(msgspec.Struct, frozen=True):
    """An entry of the list: `how` is BROUGHT or SEEN."""

    how: str
    digest: str
    path: str


class HostFiles(msgspec.Struct):
    """What a host has. `machine` and `programs` are the first bytes of programs, as hexadecimal texts: of its own
    system, and of programs by path. `runnable` are those that can be executed. `digests` are those of all files that
    are there, by path; `list` is the path of the list, and `pushed` its content; `others` are paths in the lists of
    other deployments."""

    machine: str = ""
    rsync: str = ""
    home: str = ""
    list: str = ""
    pushed: dict[str, PushedFile] = {}
    others: set[str] = set()
    programs: dict[str, str] = {}
    runnable: set[str] = set()
    digests: dict[str, str] = {}


def name_of(network: Network, host: NetworkHost) -> str:
    """The name of the list: the same for all operators who push to the same folder of a host."""
    folder = folder_on(host, network.folder)
    return f"{network.name}-{digest(folder.encode(errors='surrogateescape'))[:12]}"


def ask(network: Network, host: NetworkHost, programs: Iterable[str], files: Iterable[str]) -> HostFiles:
    """What the host has. Raises HostFailed."""
    name = name_of(network, host)
    given = _texts([name, *programs, "", *files])
    done = run_on(host, ["bash", "-c", resources.text("templates/push/ask.sh"), "ask"], given)
    texts = done.output.decode(errors="surrogateescape").split("\0")[:-1]
    found, own, at = HostFiles(), False, 0
    while at < len(texts) and texts[at] != "d":
        kind, text = texts[at][:1], texts[at][1:]
        at += 1
        if kind == "m":
            found.machine = text
        elif kind == "r":
            found.rsync = text
        elif kind == "b":
            found.list = f"{text}/{name}"
        elif kind == "h":
            found.home = text
        elif kind == "l":
            own = text == name
        elif kind == "p":
            start, _, path = text[1:].partition(" ")
            found.programs[path] = start
            if text[0] == "x":
                found.runnable.add(path)
        elif kind in (BROUGHT, SEEN):
            one = PushedFile(kind, *text.lstrip().split(" ", 1))
            if own:
                found.pushed[one.path] = one
            elif one.how == BROUGHT:
                found.others.add(one.path)
    if done.code or at >= len(texts):
        raise HostFailed(done.reason("the answer is not valid"))
    for text in texts[at + 1 :]:
        value, _, path = text.partition("  ")
        found.digests[path] = value
    return found


def keep(
    host: NetworkHost, list_path: str, entries: Iterable[PushedFile], folders: Sequence[str] = (),
    gone: Iterable[tuple[str, str]] = (),
) -> None:  # fmt: skip
    """Writes the list of a host, after it has created folders and deleted files. `gone` are pairs of the folder above
    which no empty folder is deleted, and the path of a file. Raises HostFailed."""
    texts = [list_path, *(f"{one.how} {one.digest} {one.path}" for one in entries), "", *folders, ""]
    texts += [text for pair in gone for text in pair]
    script = resources.text("templates/push/keep.sh")
    done = run_on(host, ["bash", "-c", script, "keep"], _texts(texts))
    if done.code:
        raise HostFailed(done.reason().removeprefix("keep: "))


def _texts(texts: Iterable[str]) -> bytes:
    return "".join(f"{text}\0" for text in texts).encode(errors="surrogateescape")


def digest_of(path: str) -> str:
    """The digest of a file as the host computes it, '' if it cannot be read."""
    try:
        with open(path, "rb", opener=regular) as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return ""


def start_of(path: str) -> str:
    """The first bytes of a program of this machine, '' if it cannot be read."""
    return (content(path, 20) or b"").hex()


def is_native(start: str) -> bool:
    """Whether a program is for one kind of machine only."""
    return start.startswith(_ELF)


def is_same_kind(start: str, other: str) -> bool:
    """Whether two native programs are for the same kind of machine: width, byte order and processor."""
    return (start[8:12], start[36:40]) == (other[8:12], other[36:40])


def kind_in_words(start: str) -> str:
    return _KINDS.get(start[36:40], f"machine {start[36:40]}")
