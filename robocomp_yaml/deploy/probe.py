"""The probe of hosts: which of a network's programs a host has, in which version, and what they lack. One small script,
which runs locally or over ssh and reads names as data, answers this.

No program is run for its version, because a component would start to work: a version is the digest of a file and its
date.
"""

from __future__ import annotations

import asyncio
import os
import shlex
from collections.abc import Sequence

import msgspec

from robocomp_yaml import languages, resources
from robocomp_yaml.deploy.local.obstacles import is_local
from robocomp_yaml.diag.codes import deploying as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.network.network import Network, NetworkHost, Process

WITHIN = 60.0
NODE = "the IceGrid node"
"""What is shown as the user of `icegridnode`."""
SCRIPT = "templates/probe/ask.sh"


def modules() -> str:
    """The code for each Python: which Python runs a component, and which modules it lacks."""
    return languages.language("python").text("runtime/interpreter.py") + resources.text("templates/probe/modules.py")


VARIABLE = "RCYAML_PYTHON"
"""The variable of a process that sets its Python."""


class ProgramQuery(msgspec.Struct, frozen=True):
    """A program to probe. `python` is the value of the process's VARIABLE, '' if it has none."""

    program: str
    python: str = ""


class ProbeFailed(Exception):
    """The host cannot be probed; the text has the reason."""


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
        if variable.name == VARIABLE:
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
        if isinstance(answer, ProbeFailed):
            failed.append(codes.NO_ANSWER.at(host.span, host=host.name, address=host.address, reason=answer))
        elif isinstance(answer, BaseException):
            raise answer
        else:
            answers[host.name] = answer
    return answers, failed


async def probe(host: NetworkHost, queries: dict[ProgramQuery, tuple[str, ...]]) -> list[ProbedProgram]:
    """The programs of a host. Raises ProbeFailed."""
    script = ["sh", "-c", resources.text(SCRIPT), "ask", modules()]
    command = script if is_local(host.address) else _over_ssh(host, script)
    try:
        process = await asyncio.create_subprocess_exec(
            *command, stdin=asyncio.subprocess.PIPE, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE
        )
    except OSError as error:
        raise ProbeFailed(f"cannot run {command[0]}: {(error.strerror or str(error)).lower()}") from error
    questions = "".join(f"{one.python}\t{one.program}\n" for one in queries).encode(errors="surrogateescape")
    try:
        answer, errors = await asyncio.wait_for(process.communicate(questions), WITHIN)
    except TimeoutError as error:
        process.kill()
        await process.wait()
        raise ProbeFailed(f"no answer within {WITHIN:g} s") from error
    lines = answer.decode(errors="surrogateescape").splitlines()
    if process.returncode or len(lines) != len(queries):
        text = errors.decode("utf-8", "replace").strip().splitlines()
        raise ProbeFailed(text[-1] if text else f"the answer is not valid (exit code {process.returncode})")
    answers = zip(queries.items(), lines, strict=True)
    return [_found(one.program, used_by, line.split("\t")) for (one, used_by), line in answers]


def _found(program: str, used_by: tuple[str, ...], fields: Sequence[str]) -> ProbedProgram:
    path, digest, day, missing = fields
    return ProbedProgram(program, used_by, path, digest, day, tuple(missing.split()))


def _over_ssh(host: NetworkHost, script: Sequence[str]) -> list[str]:
    """The command that runs the script on a host. The remote shell gets it in quotes; nothing in it is from a
    document."""
    login = f"{host.user}@{host.address}" if host.user else host.address
    return ["ssh", "-o", "BatchMode=yes", "-o", "ConnectTimeout=10", "--", login, shlex.join(script)]
