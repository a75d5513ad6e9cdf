"""One check, before anything starts, of all that the processes of another host need there: folders, programs, files
that are missing or stale, files of variables, modules of Python, and rights for limits."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable, Iterable, Sequence

from msgspec.structs import replace

from robocomp_yaml import languages, resources
from robocomp_yaml.deploy import interfaces, limits
from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.probe import modules
from robocomp_yaml.deploy.push.host_files import digest_of
from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.diag.codes import deploying as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.listing import some
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.network import files
from robocomp_yaml.network.network import PYTHON, Network, NetworkHost, Process
from robocomp_yaml.source.ice_endpoint import spelled_host

CHECK = "rcyaml.check"
"""The name of the server that runs the check. No process can have this name."""

_MARK = "rcyaml-check"
_MOST = 60_000  # bytes of one check
_DIGITS = 16
_SHOWN = 3


def lacking(
    network: Network, specs: Sequence[ProcessSpec], run: Callable[[ProcessSpec, tuple[str, ...], list[str]], int]
) -> list[Diagnostic]:  # fmt: skip
    """Diagnostics for all that the hosts of these processes lack, or have in another version. `run` returns the exit
    code of a command that runs beside a process, and adds its output to a list."""
    found: list[Diagnostic] = []
    for name in dict.fromkeys(spec.process.host for spec in specs):
        own, host = [one for one in specs if one.process.host == name], network.hosts[name]
        beside = replace(own[0], process=Process(CHECK, name, own[0].command, "/"))
        for command in commands(network, host, own):
            lines: list[str] = []
            code = run(beside, command, lines)
            found += answers(network, host, own, lines)
            if code:
                reason = f"what it has cannot be checked (exit code {code})"
                where = network.span_of_host(host)
                found.append(codes.NO_ANSWER.at(where, host=name, address=host.address, reason=reason))
    return found


def commands(network: Network, host: NetworkHost, specs: Sequence[ProcessSpec]) -> list[tuple[str, ...]]:
    """The commands that check the processes of a host, each for some of them."""
    head = ("bash", "-c", resources.text("templates/icegrid/check.sh"), "check")
    found: list[tuple[str, ...]] = []
    known: dict[str, tuple[str, ...]] = {}
    digests: dict[str, str] = {}
    pythons: set[str] = set()
    words: list[str] = []
    for number, spec in enumerate(specs):
        own = _words(network, host, number, spec, known, digests, pythons)
        if words and sum(map(len, words)) + sum(map(len, own)) > _MOST:
            found.append((*head, *words))
            words = []
        words += own
    return [*found, (*head, *words)] if words else found


def _words(
    network: Network, host: NetworkHost, number: int, spec: ProcessSpec, known: dict[str, tuple[str, ...]],
    digests: dict[str, str], pythons: set[str],
) -> list[str]:  # fmt: skip
    process, program = spec.process, spec.command[0]
    has_own_path = "/" not in program and any(variable.name == "PATH" for variable in process.env)
    words = ["p", str(number), process.cwd, "" if has_own_path else program]
    for variable in process.env:
        words += ["v", variable.name, variable.file] if variable.file else []
    here = network.processes.get(spec.name)
    for path in files.needed(here, known) if here else ():
        if path not in digests:
            digests[path] = digest_of(path)[:_DIGITS]
            words += ["f", digests[path], host.there(path)] if digests[path] else []
    python = next((variable.value for variable in process.env if variable.name == PYTHON), "")
    if here and here.component and _is_python(here.watched) and python not in pythons:
        pythons.add(python)
        words += ["m", python, modules()]
    for name in interfaces.names_of(process, host.address):
        is_reached = any(f" -h {spelled_host(host.address)} " in endpoint.text for endpoint in process.endpoints)
        words += ["l", name, "" if is_reached else "only"]
    for key, test in limits.tests(process.limits):
        words += ["t", key, str(len(test)), *test]
    return words


def _is_python(watched: Iterable[str]) -> bool:
    return any(path.endswith(languages.language("python").suffixes) for path in watched)


def answers(
    network: Network, host: NetworkHost, specs: Sequence[ProcessSpec], lines: Iterable[str]
) -> list[Diagnostic]:  # fmt: skip
    """The diagnostics of what a check has printed, also with the times of a log."""
    found: list[Diagnostic] = []
    stale: dict[int, list[str]] = {}
    missing: set[int] = set()
    for line in lines:
        _, mark, rest = line.partition(f"{_MARK}\t")
        number, _, fault = rest.partition("\t")
        kind, _, text = fault.partition("\t")
        if not mark or not number.isdigit() or int(number) >= len(specs):
            continue
        if kind in ("differs", "gone"):
            stale.setdefault(int(number), []).append(text)
        else:
            missing |= {int(number)} if kind in ("folder", "file") else set()
            found.append(_of_line(network, host, specs[int(number)], kind, text))
    for of_process, paths in stale.items():
        if of_process in missing:
            continue  # the same push brings all
        found.append(
            codes.CANNOT.at(
                specs[of_process].process.span, name=specs[of_process].name, what="started",
                reason=f"the host '{host.name}' has another version of {some(paths, _SHOWN)}",
                hint=f"`{_push(network, host)}` brings it",
            )
        )  # fmt: skip
    return found


def _of_line(network: Network, host: NetworkHost, spec: ProcessSpec, kind: str, text: str) -> Diagnostic:
    name, program, where = spec.name, spec.command[0], f"the host '{host.name}'"
    if kind == "limit":
        key, _, reason = text.partition(": ")
        return limits.fault(spec, key, reason.lower(), where)
    if kind in ("listen", "interface", "only"):
        listen, *known = text.split()
        reason = interfaces.missing(known) if kind == "listen" else interfaces.NO_ADDRESS
        if kind == "only":
            reason = "others cannot know the address of that interface: write `listen: [address, " + f"{listen}]`"
        return codes.NO_INTERFACE.at(spec.process.span, name=name, listen=listen, where=where, reason=reason)
    file = f"the file '{program}' is missing" if "/" in program else f"PATH contains no program '{program}'"
    reason = {
        "folder": f"its folder '{spec.process.cwd}' does not exist",
        "file": f"{file} ({os.strerror(errno.ENOENT)})",
        "right": f"'{program}' is not executable ({os.strerror(errno.EACCES)})",
        "kind": f"'{program}' is not a program for that kind of machine",
        "interpreter": f"'{program}' needs the interpreter '{text}', which is missing",
        "variable": f"{text}, which is missing, or cannot be read",
        "modules": f"its Python lacks {', '.join(text.split())}",
    }[kind]
    hint = ""
    here = network.processes.get(name)
    if kind in ("folder", "file", "right") and "/" in program:
        is_here = here is not None and os.path.isfile(here.command[0])
        hint = f"`{_push(network, host)}` brings it" if is_here else spec.process.build
    elif kind == "kind":
        hint = spec.process.build and f"build it on that host: {spec.process.build}"
    elif kind == "modules" and "Ice" in text.split():
        hint = "install it there (Debian: python3-zeroc-ice), or set `python:` of the host"
    return codes.CANNOT.at(spec.process.span, hint=hint, name=name, what="started", reason=f"{reason}, on {where}")


def _push(network: Network, host: NetworkHost) -> str:
    return typed("rcyaml", "deploy", "push", shown_path(network.path), host.name)
