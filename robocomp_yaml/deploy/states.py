"""The states of a process, and whether a process in a state is as desired: only this module decides that.

The supervisor of the local engine imports this module, too: it needs only the standard library.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robocomp_yaml.deploy.engine import Running

RUNNING = "running"
WAITING = "waiting"
"""It ended by itself, and is restarted after a delay."""
GIVEN_UP = "given up"
"""It ended by itself too often, or failed and its policy does not restart it."""
ENDED = "ended"
"""It ended by itself with exit code 0, and its policy does not restart it then."""
STOPPED = "stopped"
LOST = "lost"
"""Its state is unknown, because its host does not answer."""
UNSTABLE = "unstable"
"""It runs, or is restarted, but ends again and again. No engine reports this state: it follows from the last ends."""

ALIVE = (RUNNING, WAITING)
"""It runs, or its engine restarts it."""
OVER = (GIVEN_UP, ENDED)
"""It ended by itself, and its engine does not restart it."""
SILENT = (STOPPED, LOST)
"""Nothing can be stopped: it does not run, or its host does not answer."""

ENDS = 3
"""The number of ends by which a process is judged as unstable."""
_LONGEST = 60.0  # seconds from the first of these ends to the last
_CALM = 5.0  # the least seconds after which a process that ended again and again counts as stable


def is_unstable(one: Running) -> bool:
    """Whether a process ended by itself three times within a minute, and its current run is not yet longer than the
    time from the first to the last of these ends."""
    if one.state not in ALIVE or one.spread is None or one.spread > _LONGEST:
        return False
    return one.state == WAITING or one.uptime < max(one.spread, _CALM)


def state_of(one: Running) -> str:
    """The state as it is shown."""
    return UNSTABLE if is_unstable(one) else one.state


def is_done(one: Running, *, is_server: bool) -> bool:
    """Whether a task has done its work."""
    return one.state == ENDED and not is_server


def fault(one: Running, *, is_server: bool) -> str:
    """Why a process that was started is not as desired, '' if it is. Somebody stopped a process that is STOPPED. A
    process that runs may still not be ready."""
    how = f": {one.last_exit}" if one.last_exit else ""
    if is_unstable(one):
        return f"it ends again and again{how}"
    if one.state == RUNNING and one.not_alive:
        return f"it is not alive: {one.not_alive}"
    if one.state in (RUNNING, STOPPED) or is_done(one, is_server=is_server):
        return ""
    return _FAULTS[one.state] + how


_FAULTS = {
    WAITING: "it ended by itself",
    GIVEN_UP: "it was given up",
    ENDED: "it ended by itself",
    LOST: "its host did not answer",
}
