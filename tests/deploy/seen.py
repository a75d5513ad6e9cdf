"""What /proc shows of a deployment, so that tests need not believe what rcyaml says of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeVar

from processes import until
from robocomp_yaml.deploy.local import procfs
from robocomp_yaml.deploy.states import ENDED, GIVEN_UP, STOPPED

Told = TypeVar("Told")
_PATIENCE = 20.0  # seconds: between the question and the look at /proc, a process may start or end


def programs(folder: str, name: str) -> list[int]:
    """The pids of the running programs of this name, without those that supervise them. A program can have started
    others in sessions of their own."""
    marked = (pid for pid in procfs.marked(folder) if procfs.mark_of(pid) == f"{folder}:{name}")
    return [pid for pid in marked if (one := procfs.entry(pid)) and one.group == pid and not one.is_dead]


def agreed(folder: str, ask: Callable[[], Told], told: Callable[[Told], Mapping[str, tuple[str, int]]]) -> Told:
    """The answer of `ask`, as soon as /proc agrees with it: what it says has a pid runs, with that pid and under its
    name; of what it says has ended, nothing runs. `told` are the states and pids in an answer."""
    answer: list[Told] = []

    def faults() -> list[str]:
        answer[:] = [ask()]
        found = []
        for name, (state, pid) in told(answer[0]).items():
            running = programs(folder, name)
            if (pid and pid not in running) or (state in (STOPPED, GIVEN_UP, ENDED) and running):
                found.append(f"{name} is told to be {state} with pid {pid}, and /proc has {running}")
        return found

    last: list[str] = []

    def is_agreed() -> bool:
        last[:] = faults()
        return not last

    until(is_agreed, lambda: str(last), _PATIENCE)
    return answer[0]
