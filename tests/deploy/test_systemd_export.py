"""Units exported for systemd run in a systemd of the test: they start in order, and are restarted."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from conftest import write_tree
from processes import Running, until
from robocomp_yaml.emit.exports import export
from robocomp_yaml.network.network import (
    LOOPBACK,
    PROGRAM,
    EnvironmentVariable,
    Network,
    NetworkHost,
    Process,
    RestartRule,
)
from small_networks import config_of, shell, sleeper

MANAGER = shutil.which("systemd", path="/usr/lib/systemd:/lib/systemd")
ODD = ("a b", ";", "$HOME", "${x}", "100%", 'say "hi"', "back\\slash", "--end", "", "%i", "é")
SCRIPT = """import json, os, sys, time
with open("told.new", "w") as file:
    json.dump([sys.argv[1:], os.environ["TITLE"], os.environ["TOKEN"], os.getcwd()], file)
os.rename("told.new", "told")
time.sleep(600)
"""
# A user's systemd among processes of its own, of which it must not be the first; it starts only where the one of the
# system seems to be.
ALONE = """\
mount -t tmpfs tmpfs /run && mkdir -p /run/systemd/system || exit 1
"$@"
exit
"""

Systemctl = Callable[..., str]


@pytest.fixture
def systemctl() -> Iterator[Systemctl]:
    """`systemctl(WORDS)` returns the output for a `systemctl.manager` with the home `systemctl.home`."""
    if MANAGER is None or os.geteuid() != 0:
        pytest.skip("systemd is not installed here (Debian: systemd), or only root may have one of its own")
    with tempfile.TemporaryDirectory(prefix="systemd") as name:
        home, own = Path(name), {"HOME": name, "XDG_RUNTIME_DIR": name, "PATH": os.environ["PATH"]}
        command = ["unshare", "--fork", "--pid", "--mount", "--mount-proc", "--kill-child",
                   "sh", "-c", ALONE, "sh", MANAGER, "--user", "--unit=basic.target"]  # fmt: skip
        manager = Running(subprocess.Popen(command, env=own, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                           stderr=subprocess.STDOUT))  # fmt: skip

        def run(*words: str) -> str:
            """The manager accepts it only from its own processes."""
            children = Path(f"/proc/{manager.process.pid}/task/{manager.process.pid}/children").read_text()
            inside = ["nsenter", "--pid", "--mount", "--target", *children.split()]
            asked = [*inside, "systemctl", "--user", *words]
            done = subprocess.run(asked, env=own, capture_output=True, text=True, timeout=30)
            return done.stdout + done.stderr

        try:
            ended = manager.process.poll
            until(lambda: run("is-active", "basic.target") == "active\n" or ended() is not None, "systemd")
            if ended() is not None:
                pytest.skip(f"systemd does not run here: {manager.output.strip()}")
            run.home, run.manager = home, manager  # type: ignore[attr-defined]
            yield run
            run("exit")
            manager.exit_code()
        finally:
            manager.end()
            for name in ("init.scope", "session.slice"):
                for path in sorted(Path("/sys/fs/cgroup").glob(f"*/{name}/**"), reverse=True):
                    with suppress(OSError):  # that of the machine's own systemd is not empty
                        path.rmdir()


def install(systemctl: Systemctl, *processes: Process) -> None:
    """Installs units and config/ as docs/exports.md says."""
    network = Network("Robot", "/robot.ddsl.yaml", "/f", {LOOPBACK: NetworkHost(LOOPBACK)})
    network.processes.update({process.name: process for process in processes})
    settings = systemctl.home / ".config"  # type: ignore[attr-defined]
    for path, text in export(network, "systemd").items():
        write_tree(settings, {("Robot/" if path.startswith("config/") else "systemd/user/") + path: text})
    (settings / "Robot").mkdir(exist_ok=True)
    (settings / "Robot" / "odd.env").write_text("TOKEN=a secret\n", encoding="utf-8")


def test_the_units_run(systemctl: Systemctl, tmp_path: Path) -> None:
    folder = tmp_path / "50% of it"
    folder.mkdir()
    odd = Process(
        "odd", LOOPBACK, ("python3", "-c", SCRIPT, *ODD), str(folder), PROGRAM, is_ice=False,
        env=(EnvironmentVariable("TITLE", 'a $title 50% "q" \\x'), EnvironmentVariable("TOKEN", source="ROBOT_TOKEN")),
    )  # fmt: skip
    logged = f"echo $0 >> {tmp_path}/order; exec sleep 600"
    config = config_of("configured", "x = $HOME 100%\n")
    configured = shell("configured", f'cat "$0" > {tmp_path}/config', config=config)
    in_folder = sleeper("in_folder", folders=(str(tmp_path / "made for it"),))
    processes = [Process(name, LOOPBACK, ("sh", "-c", logged, name), "/", PROGRAM, after=after, is_ice=False)
                 for name, after in (("last", ("middle",)), ("middle", ("first",)), ("first", ()))]  # fmt: skip
    install(systemctl, odd, configured, in_folder, *processes)

    assert "Created symlink" in systemctl("enable", "--now", "Robot.target")
    until((folder / "told").exists, lambda: systemctl("status", "Robot-odd.service") + systemctl.manager.output)
    told = json.loads((folder / "told").read_text(encoding="utf-8"))
    assert told == [list(ODD), 'a $title 50% "q" \\x', "a secret", str(folder)]
    until(lambda: (tmp_path / "config").exists(), lambda: systemctl("status", "Robot-configured.service"))
    assert (tmp_path / "config").read_text(encoding="utf-8") == "x = $HOME 100%\n"
    until(lambda: systemctl("is-active", "Robot-in_folder.service") == "active\n", "the folder's user")
    assert (tmp_path / "made for it").is_dir()
    started = until(lambda: len(names := (tmp_path / "order").read_text().split()) == 3 and names, "all three")
    assert sorted(started) == ["first", "last", "middle"]
    times = [int(systemctl("show", "-P", "ExecMainStartTimestampMonotonic", f"Robot-{name}.service"))
             for name in ("first", "middle", "last")]  # fmt: skip
    assert times == sorted(times)

    systemctl("stop", "Robot.target")
    states = systemctl("is-active", "Robot-odd.service", "Robot-first.service", "Robot-last.service").split()
    assert states == ["inactive"] * 3


def test_a_crashed_unit_is_restarted_a_limited_number_of_times(systemctl: Systemctl, tmp_path: Path) -> None:
    loop = shell("loop", f"echo again >> {tmp_path}/crashes; exit 3", restart=RestartRule(delay=0.01, tries=3))
    install(systemctl, loop, sleeper("steady"))
    systemctl("start", "Robot.target")
    until(lambda: systemctl("is-active", "Robot-steady.service") == "active\n", "it runs")
    systemctl("kill", "-s", "KILL", "Robot-steady.service")
    until(lambda: systemctl("show", "-P", "NRestarts", "Robot-steady.service") == "1\n", "it is restarted")
    until(lambda: systemctl("is-active", "Robot-steady.service") == "active\n", "it runs again")
    until(lambda: systemctl("is-active", "Robot-loop.service") == "failed\n", "it is given up")
    assert (tmp_path / "crashes").read_text() == "again\n" * 4, "once, and three times more"
