"""The supervisor of one deployment on this machine: `python -m robocomp_yaml.deploy.local.supervisor FOLDER [PID]`.

It consists of two processes. The supervisor itself starts and restarts the children, and answers on the control socket,
in lines of JSON. Its parent, the keeper, lets the supervisor go on when it was halted, waits until it has ended, and
then kills all descendants that it left, which Linux has made children of the keeper. With the PID of the process that
started it, the supervisor stops its children when that process ends, for whatever reason. Both use only the standard
library, and the keeper forks before most of it is imported, so that both stay small.
"""

from __future__ import annotations

import os
import signal
import sys

from robocomp_yaml.deploy.local import kernel, procfs, record


def main() -> None:
    folder = sys.argv[1]
    kernel.adopt_orphans()
    supervisor = os.fork()
    if supervisor == 0:
        from robocomp_yaml.deploy.local.service import serve

        kernel.adopt_orphans()
        serve(folder)
        sys.exit(0)
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        signal.signal(number, lambda number, frame: procfs.send(supervisor, number))
    if len(sys.argv) > 2 and not kernel.signal_at_end_of(int(sys.argv[2]), signal.SIGTERM):
        procfs.send(supervisor, signal.SIGTERM)
    status = _wait_for(supervisor)
    _end_all()
    if status == 0:
        record.remove(folder)


def _wait_for(supervisor: int) -> int:
    """The exit status of the supervisor, which goes on at once when it was halted."""
    while True:
        pid, status = os.waitpid(-1, os.WUNTRACED)
        if pid == supervisor and os.WIFSTOPPED(status):
            procfs.send(pid, signal.SIGCONT)
        elif pid == supervisor:
            return status


def _end_all() -> None:
    """Kills all descendants of this process, until none is left: children of a killed process become its own."""
    while True:
        for pid in procfs.descendants([os.getpid()], procfs.table()) - {os.getpid()}:
            procfs.send(pid, signal.SIGKILL)
        try:
            os.wait()
        except ChildProcessError:
            return


if __name__ == "__main__":
    main()
