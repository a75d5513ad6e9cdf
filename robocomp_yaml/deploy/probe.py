"""The probe of hosts: which of a network's programs a host has, in which version, and what they lack. One small script,
which runs locally or over ssh and reads names as data, answers this.

No program is run for its version, because a component would start to work: a version is the digest of a file and its
date.
"""

from __future__ import annotations

import asyncio
import os
import subprocess
from collections.abc import Sequence

import msgspec

from robocomp_yaml import languages, resources
from robocomp_yaml.deploy.here import is_here
from robocomp_yaml.deploy.ssh import CLIENT, CommandResult, HostFailed
from robocomp_yaml.diag.codes import deploying as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import reason_of
from robocomp_yaml.network.network import PYTHON, Network, NetworkHost, Process

WITHIN = 60.0
NODE = "the IceGrid node"
"""What is shown as the user of `icegridnode`."""
SCRIPT = "templates/probe/ask.sh"


def modules() -> str:
    """The code for each Python: which Python runs a component, and which modules it lacks."""
    return languages.language("python").text("runtime/interpreter.py") + resources.text("templates/probe/modules.py")


class ProgramQuery(msgspec.Struct, frozen=True):
    """A program to probe. `python` is the value of the process's variable PYTHON, '' if it has none."""

    program: str
    python: str = ""


class ProbedProgram(msgspec.Struct, frozen=True):
    """A program on a host. `path` is '' if the host lacks the program. `missing` is what the program needs and the host
    lacks: libraries, the interpreter of a script, modules of a Python program. `used_by` are the processes that run
    it."""

    program: str
    used_by: tuple[str, ...]
    path: str = ""
    digest: str = ""
    day: str = ""
    missing: tuple[str, ...] = ()

    @property
    def can_run(self) -> bool:
        return bool(self.path) and not self.missing


def programs(network: Network) -> dict[ProgramQuery, tuple[str, ...]]:
    """The programs of a network, each with the names of its processes. A program with a line break in its name cannot
    be probed. With several hosts, each needs IceGrid's node, too."""
    found: dict[ProgramQuery, tuple[str, ...]] = {}
    for process in network.enabled():
        query = ProgramQuery(process.command[0], _python_of(process, network))
        if "\n" not in query.program:
            found[query] = (*found.get(query, ()), process.name)
    return found | {ProgramQuery("icegridnode"): (NODE,)} if network.is_distributed else found


def _python_of(process: Process, network: Network) -> str:
    """The Python that the process's own environment sets. A variable of another host's environment is unknown."""
    for variable in process.env:
        if variable.name == PYTHON:
            is_local = variable.source and not network.is_distributed
            value = os.environ.get(variable.source, "") if is_local else variable.value
            if {"\n", "\t"} & set(value):
                return ""
            return os.path.join(process.cwd, value) if "/" in value and value[0] != "~" else value
    return ""


def can_run(network: Network, host: str, found: Sequence[ProbedProgram]) -> bool:
    """Whether a host can run all its processes."""
    own = {process.name for process in network.enabled() if process.host == host} | {NODE}
    return all(one.can_run for one in found if own & set(one.used_by))


async def ask(
    network: Network, hosts: Sequence[NetworkHost]
) -> tuple[dict[str, list[ProbedProgram]], list[Diagnostic]]:
    """The programs of each host by the host's name, and diagnostics for hosts that do not answer."""
    queries = programs(network)
    results = await asyncio.gather(*(probe(host, queries) for host in hosts), return_exceptions=True)
    answers: dict[str, list[ProbedProgram]] = {}
    failed: list[Diagnostic] = []
    for host, answer in zip(hosts, results, strict=True):
        if isinstance(answer, HostFailed):
            failed.append(
                codes.NO_ANSWER.at(host.span, host=host.name, address=host.address, reason=answer, hint=answer.hint)
            )
        elif isinstance(answer, BaseException):
            raise answer
        else:
            answers[host.name] = answer
    return answers, failed


async def probe(host: NetworkHost, queries: dict[ProgramQuery, tuple[str, ...]]) -> list[ProbedProgram]:
    """The programs of a host. Raises HostFailed."""
    is_far = bool(host.folders) and not is_here(host)
    there = [host.there(one.program) if is_far and one.program.startswith("/") else one.program for one in queries]
    questions = "".join(f"{one.python}\t{path}\n" for one, path in zip(queries, there, strict=True)).encode(
        errors="surrogateescape"
    )
    script = ["sh", "-c", resources.text(SCRIPT), "ask", modules()]
    done = await asyncio.to_thread(run_on, host, script, questions)
    lines = done.output.decode(errors="surrogateescape").splitlines()
    if done.code or len(lines) != len(queries):
        raise HostFailed(done.reason("the answer is not valid"))
    answers = zip(queries.items(), lines, strict=True)
    return [_found(one.program, used_by, line.split("\t")) for (one, used_by), line in answers]


def _found(program: str, used_by: tuple[str, ...], fields: Sequence[str]) -> ProbedProgram:
    path, digest, day, missing = fields
    return ProbedProgram(program, used_by, path, digest, day, tuple(missing.split()))


def run_on(host: NetworkHost, script: list[str], given: bytes = b"") -> CommandResult:
    """The result of a command on a host. Raises HostFailed."""
    if not is_here(host):
        return CLIENT.run(host, script, given, WITHIN)
    try:
        found = subprocess.run(script, input=given, capture_output=True, check=False, timeout=WITHIN)
    except subprocess.TimeoutExpired as error:
        raise HostFailed(f"no answer within {WITHIN:g} s") from error
    except OSError as error:
        raise HostFailed(f"cannot run {script[0]}: {reason_of(error)}") from error
    return CommandResult(found.returncode, found.stdout, found.stderr.decode(errors="replace"))
