"""A machine that boots: a real systemd, of a user or of the machine, among processes of its own. Its power is cut by
killing it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from processes import until
from robocomp_yaml.deploy.local import procfs

MANAGER = shutil.which("systemd", path="/usr/lib/systemd:/lib/systemd")
# It is not the first of its processes, and starts only where the systemd of the machine seems to be.
_ALONE = """\
mount -t tmpfs tmpfs /run && mkdir -p /run/systemd/system || exit 1
"$@"
exit
"""
# The first of its processes. Nothing that belongs to the distribution may run, because it would work on the real files:
# so the machine has only targets, which do nothing, and the units of the test.
_FIRST = """\
mount -t tmpfs tmpfs /run || exit 1
for folder in /usr/lib/systemd /usr/local/lib/systemd /etc/systemd; do
    for part in system system-generators; do
        [ ! -d "$folder/$part" ] || mount -t tmpfs tmpfs "$folder/$part" || exit 1
    done
done
for target in sysinit basic network network-online multi-user shutdown sockets timers paths slices umount final; do
    printf '[Unit]\\nDefaultDependencies=no\\n' >"/usr/lib/systemd/system/$target.target"
done
mount --bind "$1" /etc/systemd/system || exit 1
exec env -i container=test "$2" --system --unit=multi-user.target --log-target=console --show-status=no
"""


def need_systemd() -> None:
    if MANAGER is None or os.geteuid() != 0:
        pytest.skip("systemd is not installed here (Debian: systemd), or only root may have one of its own")


class Machine:
    """A machine with the home `home`. `inside` are the words that run a command in its network. `manager` is that of
    its units: `user`, or `system`, which is switched on only inside of it."""

    def __init__(self, home: Path, inside: Sequence[str] = (), manager: str = "user") -> None:
        self.home, self._inside, self.manager = home, list(inside), manager
        self.units = home / ("config/systemd/user" if manager == "user" else "units")
        (home / "run").mkdir(parents=True, mode=0o700)
        (home / "units").mkdir()
        self.environment = {
            "HOME": str(home), "XDG_RUNTIME_DIR": f"{home}/run", "XDG_CONFIG_HOME": f"{home}/config",
            "XDG_STATE_HOME": f"{home}/state", "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}",
        }  # fmt: skip
        self._power: subprocess.Popen[bytes] | None = None

    def boot(self) -> None:
        """Starts only what systemd starts."""
        assert MANAGER
        shutil.rmtree(self.home / "run")
        (self.home / "run").mkdir(mode=0o700)
        words = ["unshare", "--fork", "--pid", "--mount", "--mount-proc", "--kill-child", "sh", "-c"]
        if self.manager == "user":
            words += [_ALONE, "sh", MANAGER, "--user", "--unit=default.target"]
        else:
            words += [_FIRST, "sh", str(self.home / "units"), MANAGER]
        with open(self.home / "systemd.log", "wb") as log:
            self._power = subprocess.Popen(
                [*self._inside, *words], env=self.environment, stdin=subprocess.DEVNULL, stdout=log, stderr=log
            )  # fmt: skip
        power = self._power
        until(lambda: "running" in self.systemctl("show", "-p", "SystemState") or power.poll() is not None
              or bool(self.systemctl("show", "-p", "Version").strip()), "systemd runs")  # fmt: skip
        if power.poll() is not None:
            pytest.skip(f"systemd does not run here: {(self.home / 'systemd.log').read_text(encoding='utf-8')}")

    def cut(self) -> None:
        """Cuts the power: all its processes end at once; the first of them ends after all others."""
        if self._power:
            first = self._first()
            self._power.kill()
            self._power.wait()
            self._power = None
            until(lambda: not procfs.table().keys() & set(first), "its processes end")

    def run(self, *words: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
        """A command on the machine; while it is off, beside it."""
        return subprocess.run(
            [*self._inside, *self._enter(), *words], cwd=cwd, env=self.environment, capture_output=True, text=True,
            check=False, timeout=120,
        )  # fmt: skip

    def rcyaml(self, *words: str, cwd: Path, code: int | None = 0) -> str:
        done = self.run(
            "env", "-C", str(cwd), sys.executable, "-m", "robocomp_yaml", "deploy", *words, cwd=cwd
        )  # fmt: skip
        assert code in (None, done.returncode), done.stdout + done.stderr
        return done.stdout + done.stderr

    def systemctl(self, *words: str) -> str:
        return self.run("systemctl", f"--{self.manager}", *words).stdout

    def _enter(self) -> list[str]:
        if self._power is None:
            return []
        return ["nsenter", "--pid", "--mount", "--target", str(self._first()[0])] if self._first() else []

    def _first(self) -> list[int]:
        """The first of its processes, if it runs."""
        assert self._power
        children = Path(f"/proc/{self._power.pid}/task/{self._power.pid}/children")
        return [int(pid) for pid in children.read_text(encoding="ascii").split()]
