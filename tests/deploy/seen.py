"""What /proc and a client of Ice see of a deployment, so that tests need not believe what rcyaml says of it."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import pytest
from click.testing import Result

from processes import answers, until
from robocomp_yaml.deploy.local import procfs
from robocomp_yaml.deploy.states import ENDED, GIVEN_UP, STOPPED

Told = TypeVar("Told")
NEEDS_ICEGRID = pytest.mark.skipif(
    shutil.which("icegridnode") is None, reason="IceGrid is not installed (Debian: zeroc-icegrid)"
)
_PATIENCE = 20.0  # seconds: between the question and the look at /proc, a process may start or end


def programs(folder: str, name: str) -> list[int]:
    """The pids of the running programs of this name, without those that supervise them. A program can have started
    others in sessions of their own."""
    marked = (pid for pid in procfs.marked(folder) if procfs.mark_of(pid) == f"{folder}:{name}")
    return [pid for pid in marked if (one := procfs.entry(pid)) and one.group == pid and not one.is_dead]


def status(
    rcyaml: Callable[..., Result], folder: str, document: str, *words: str, is_ice: bool = False
) -> dict[str, dict[str, Any]]:
    """The status of each process of the deployment in a folder by its name, as soon as /proc agrees with it. If all
    servers are Ice's, an object of each that is ready must answer a client of Ice."""

    def ask() -> dict[str, dict[str, Any]]:
        said = rcyaml("deploy", "status", document, *words, "--format", "json")
        return {one["name"]: one for one in json.loads(said.stdout)["processes"]}

    def have_answered(said: dict[str, dict[str, Any]]) -> bool:
        served = [end for one in said.values() if one["ready"] for end in one["endpoints"] if end["identity"]]
        return all(pings(f"{end['identity']}:tcp -h {end['host']} -p {end['port']}") for end in served)

    found = agreed(folder, ask, states)
    assert not is_ice or have_answered(found), found
    return found


def all_ends(folder: str) -> None:
    """Waits until no process of the deployment in a folder is left, nor anything that supervises it."""
    until(lambda: not procfs.marked(folder), lambda: str([*map(procfs.command, procfs.marked(folder))]))


def states(status: Mapping[str, Mapping[str, Any]]) -> dict[str, tuple[str, int]]:
    return {name: (one["state"], one["pid"]) for name, one in status.items()}


def pings(proxy: str) -> bool:
    """Whether an object answers within two seconds."""
    import Ice

    properties = Ice.createProperties()
    for name in ("Ice.Override.ConnectTimeout", "Ice.Default.InvocationTimeout"):
        properties.setProperty(name, "2000")
    data = Ice.InitializationData()
    data.properties = properties
    with Ice.initialize(data) as ice:
        return answers(ice, proxy)


def agreed(
    folder: str, ask: Callable[[], Told], told: Callable[[Told], Mapping[str, tuple[str, int]]], *there: str
) -> Told:
    """The answer of `ask`, as soon as /proc agrees with it: what it says has a pid runs, with that pid and under its
    name; of what it says has ended, nothing runs. `told` are the states and pids in an answer, `there`
    the deployment's folders on hosts that have one of their own."""
    answer: list[Told] = []

    def faults() -> list[str]:
        answer[:] = [ask()]
        found = []
        for name, (state, pid) in told(answer[0]).items():
            running = [pid for each in (folder, *there) for pid in programs(each, name)]
            if (pid and pid not in running) or (state in (STOPPED, GIVEN_UP, ENDED) and running):
                found.append(f"{name} is told to be {state} with pid {pid}, and /proc has {running}")
        return found

    last: list[str] = []

    def is_agreed() -> bool:
        last[:] = faults()
        return not last

    until(is_agreed, lambda: str(last), _PATIENCE)
    return answer[0]
