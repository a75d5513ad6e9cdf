"""Which of a network's programs a host has, in which version, and what they lack there: asked by one small script, here
or over ssh, to which names are given as data.

No program is run to tell its version, as a component that is run starts to work: a version is the digest of a file and
the day on which it was made.
"""

from __future__ import annotations

import asyncio
import os
import shlex
from collections.abc import Sequence

import msgspec

from robocomp_yaml import languages, resources
from robocomp_yaml.deploy.local.obstacles import is_here
from robocomp_yaml.diag.codes import deploying as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.network.network import Network, NetworkHost, Process

WITHIN = 60.0
NODE = "the IceGrid node"
"""What is said to use `icegridnode`."""
SCRIPT = "templates/probe/ask.sh"


def modules() -> str:
    """What is told to each Python, as one text: which runs a component, and what the one at hand does not find."""
    return languages.language("python").text("runtime/interpreter.py") + resources.text("templates/probe/modules.py")


VARIABLE = "RCYAML_PYTHON"
"""With this, a process says which Python runs it."""


class ProgramQuery(msgspec.Struct, frozen=True):
    """A program to ask for; `python` is the process's VARIABLE, '' where it has none of its own."""

    program: str
    python: str = ""


class ProbeFailed(Exception):
    """The host cannot be asked; the text says why."""


class ProbedProgram(msgspec.Struct, frozen=True):
    """A program on a host. `path` is '' where the host does not have it; `missing` is what it needs and the host lacks:
    libraries, the interpreter of a script, modules of a Python program. `used_by` are the processes that run it."""

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
    """The programs of a network's processes, each with the names of those. One whose name has a line break in it
    cannot be asked for. Where there are several hosts, each needs IceGrid's node as well."""
    found: dict[ProgramQuery, tuple[str, ...]] = {}
    for process in network.enabled():
        wanted = ProgramQuery(process.command[0], _python_of(process, network))
        if "\n" not in wanted.program:
            found[wanted] = (*found.get(wanted, ()), process.name)
    return found | {ProgramQuery("icegridnode"): (NODE,)} if network.is_distributed else found


def _python_of(process: Process, network: Network) -> str:
    """What its own environment says; what only the host knows, no document can say here."""
    for variable in process.env:
        if variable.name == VARIABLE:
            is_ours = variable.source and not network.is_distributed
            value = os.environ.get(variable.source, "") if is_ours else variable.value
            if {"\n", "\t"} & set(value):
                return ""
            return os.path.join(process.cwd, value) if "/" in value and value[0] != "~" else value
    return ""


def can_run(network: Network, host: str, found: Sequence[ProbedProgram]) -> bool:
    """Whether a host can run what the network has for it."""
    own = {process.name for process in network.enabled() if process.host == host} | {NODE}
    return all(one.can_run for one in found if own & set(one.used_by))


async def ask(
    network: Network, hosts: Sequence[NetworkHost]
) -> tuple[dict[str, list[ProbedProgram]], list[Diagnostic]]:
    """What each of these hosts has, by its name, and which do not answer."""
    wanted = programs(network)
    asked = await asyncio.gather(*(probe(host, wanted) for host in hosts), return_exceptions=True)
    answers: dict[str, list[ProbedProgram]] = {}
    failed: list[Diagnostic] = []
    for host, answer in zip(hosts, asked, strict=True):
        if isinstance(answer, ProbeFailed):
            failed.append(codes.NO_ANSWER.at(host.span, host=host.name, address=host.address, reason=answer))
        elif isinstance(answer, BaseException):
            raise answer
        else:
            answers[host.name] = answer
    return answers, failed


async def probe(host: NetworkHost, wanted: dict[ProgramQuery, tuple[str, ...]]) -> list[ProbedProgram]:
    """Raises ProbeFailed."""
    script = ["sh", "-c", resources.text(SCRIPT), "ask", modules()]
    command = script if is_here(host.address) else _over_ssh(host, script)
    try:
        asked = await asyncio.create_subprocess_exec(
            *command, stdin=asyncio.subprocess.PIPE, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE
        )
    except OSError as error:
        raise ProbeFailed(f"cannot run {command[0]}: {(error.strerror or str(error)).lower()}") from error
    questions = "".join(f"{one.python}\t{one.program}\n" for one in wanted).encode(errors="surrogateescape")
    try:
        answer, said = await asyncio.wait_for(asked.communicate(questions), WITHIN)
    except TimeoutError as error:
        asked.kill()
        await asked.wait()
        raise ProbeFailed(f"no answer within {WITHIN:g} s") from error
    lines = answer.decode(errors="surrogateescape").splitlines()
    if asked.returncode or len(lines) != len(wanted):
        text = said.decode("utf-8", "replace").strip().splitlines()
        raise ProbeFailed(text[-1] if text else f"the answer is not understood (exit code {asked.returncode})")
    answers = zip(wanted.items(), lines, strict=True)
    return [_found(one.program, used_by, line.split("\t")) for (one, used_by), line in answers]


def _found(program: str, used_by: tuple[str, ...], fields: Sequence[str]) -> ProbedProgram:
    path, digest, day, missing = fields
    return ProbedProgram(program, used_by, path, digest, day, tuple(missing.split()))


def _over_ssh(host: NetworkHost, script: Sequence[str]) -> list[str]:
    """The remote shell gets the script and what it needs in quotes; nothing in them comes from a document."""
    place = f"{host.user}@{host.address}" if host.user else host.address
    return ["ssh", "-o", "BatchMode=yes", "-o", "ConnectTimeout=10", "--", place, shlex.join(script)]
