"""The service of an installed deployment: `python -m MODULE DOCUMENT FOLDER ENGINE`.

Brings the deployment up as soon as its hosts can be reached, and says so to systemd. Later it only watches: if the
supervisor (the registry) was killed, it ends with an error, and systemd starts it again; if somebody took the
deployment down, it ends, until the next boot.
"""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from contextlib import suppress

from robocomp_yaml.deploy import history, registered
from robocomp_yaml.deploy.engines import LOCAL
from robocomp_yaml.deploy.time_limit import until
from robocomp_yaml.diag import terminal

_SHORTEST, _LONGEST = 1.0, 30.0  # seconds between two tries
_PERIOD = 1.0
_ENDS_WITHIN = 60.0
_FAULTY = 1


class Boot:
    """`is_over` is set by SIGTERM."""

    def __init__(self, document: str, folder: str, engine: str) -> None:
        self.document, self.folder, self.engine = document, folder, engine
        self.is_over = False
        self._child: subprocess.Popen[bytes] | None = None

    def run(self) -> int:
        """The exit code: 0 if somebody took the deployment down."""
        delay = _SHORTEST
        while not self.is_over:
            code = self._rcyaml("up", "--on-failure", "keep")
            if code == 0:
                break
            if code == _FAULTY and not self._is_up() and history.is_there(self.folder):
                terminal.say("the document cannot be used: what was ready last is started instead")
                if self._rcyaml("rollback", "--on-failure", "keep") == 0:
                    break
            _notify(f"STATUS=not ready yet, the next try is in {delay:g} s")
            had_it, end = self._is_there(), time.monotonic() + delay
            while time.monotonic() < end and not self.is_over:
                time.sleep(0.2)
                if had_it and not self._is_there():
                    return 0
            delay = min(2 * delay, _LONGEST)
        if not self.is_over:
            _notify("READY=1\nSTATUS=all processes are as desired")
        while not self.is_over:
            time.sleep(_PERIOD)
            if not self._is_there():
                terminal.say("the deployment was taken down")
                return 0
            if not self._is_up():
                terminal.say("the supervisor was killed")
                return 1
        self._stop()
        return 0

    def end(self) -> None:
        self.is_over = True
        if self._child:
            with suppress(ProcessLookupError):
                self._child.send_signal(signal.SIGINT)

    def _rcyaml(self, *words: str) -> int:
        what, *options = words
        command = [sys.executable, "-m", "robocomp_yaml", "deploy", what, self.document, "--engine", self.engine]
        self._child = subprocess.Popen([*command, *options], stdin=subprocess.DEVNULL)
        code = self._child.wait()
        self._child = None
        return code

    def _is_there(self) -> bool:
        """Whether the user's list has the deployment: `down` removes it."""
        return registered.of_folder(self.folder) is not None

    def _is_up(self) -> bool:
        """Whether the supervisor (the registry) runs."""
        if self.engine == LOCAL:
            one = registered.of_folder(self.folder)
            return bool(one and one.is_supervised)
        from robocomp_yaml.deploy.icegrid import daemons
        from robocomp_yaml.deploy.icegrid.grid_files import GridFiles

        return daemons.is_alive(GridFiles(self.folder).registry_folder)

    def _stop(self) -> None:
        """Ends what runs on this machine, in order. Other hosts go on."""
        _notify("STOPPING=1")
        one = registered.of_folder(self.folder)
        if self.engine == LOCAL:
            if one and one.is_supervised:
                with suppress(ProcessLookupError):
                    os.kill(one.supervisor, signal.SIGTERM)
                until(lambda: not one.is_supervised, _ENDS_WITHIN)
                # Its processes run again after the next boot: nobody took the deployment down.
                with suppress(OSError):
                    registered.keep(one)
            return
        from robocomp_yaml.deploy.icegrid import start_up
        from robocomp_yaml.deploy.icegrid.grid_files import GridFiles

        start_up.end_daemons(GridFiles(self.folder))


def _notify(text: str) -> None:
    """Says something to systemd, if that started this process."""
    address = os.environ.get("NOTIFY_SOCKET", "")
    if address:
        with suppress(OSError), socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as peer:
            peer.connect(f"\0{address[1:]}" if address[0] == "@" else address)
            peer.sendall(text.encode())


def main(document: str, folder: str, engine: str) -> int:
    boot = Boot(document, folder, engine)
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: boot.end())
    return boot.run()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:4]))
