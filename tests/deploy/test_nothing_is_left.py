"""However a deployment ends, no configuration, no token, no history and no socket of it is left after `down`."""

from __future__ import annotations

import os
import signal
import stat
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from conftest import write_tree
from processes import hanging, kill_left, until
from robocomp_yaml.deploy import protection, registered
from robocomp_yaml.deploy.local import client, procfs
from seen import NEEDS_ICEGRID
from small_networks import Place, is_alive
from test_roles import Rcyaml

DOCUMENT = """\
deployment: Robot
components:
  base: {{program: sh, args: [-c, "{base}", "{{config}}"], config: base.conf, role: server, restart: "no", {more}}}
"""
SECRET = "hunter2"
STAYS = "exec sleep 600"


@pytest.fixture
def robot(place: Place, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., str]]:
    """`robot(base=…, more=…)`: the path of a document whose process has a secret in its configuration."""
    monkeypatch.setenv("XDG_STATE_HOME", f"{tmp_path}/own")
    write_tree(tmp_path, {"base.conf": f"password={SECRET}\n"})
    (tmp_path / "base.conf").chmod(0o600)

    def write(base: str = STAYS, more: str = "") -> str:
        write_tree(tmp_path, {"robot.ddsl.yaml": DOCUMENT.format(base=base, more=more or "ready: 1 s")})
        return f"{tmp_path}/robot.ddsl.yaml"

    yield write
    kill_left(place.folder)


def left(place: Place) -> list[str]:
    """What is left that contains the secret or the token, or is a socket; and what is in the user's list."""
    found = []
    token = protection.token_of(place.folder)
    for top in (place.folder, registered.root()):
        for where, _, names in os.walk(top):
            for path in (os.path.join(where, name) for name in names):
                is_socket = stat.S_ISSOCK(os.lstat(path).st_mode)
                text = "" if is_socket else Path(path).read_text(encoding="utf-8")
                if is_socket or top == registered.root() or SECRET in text or (token and token in text):
                    found.append(os.path.relpath(path, place.root))
    return found


def test_after_down(place: Place, rcyaml: Rcyaml, robot: Callable[..., str]) -> None:
    document = robot()
    assert rcyaml("deploy", "up", document).exit_code == 0
    assert len(left(place)) > 3, "the test sees them"
    assert rcyaml("deploy", "down", document).exit_code == 0
    assert left(place) == []


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_after_the_end_of_the_supervisor(
    place: Place, rcyaml: Rcyaml, robot: Callable[..., str], number: signal.Signals
) -> None:
    document = robot()
    assert rcyaml("deploy", "up", document).exit_code == 0
    for pid in place.keeper_and_supervisor():
        os.kill(pid, number)
    place.wait_gone()
    assert rcyaml("deploy", "down", document).stdout == "Robot: nothing was running\n"
    assert left(place) == [] and rcyaml("deploy", "ls").stdout == "no deployment is running\n"


@pytest.mark.parametrize("does_keeper_hang", [False, True])
@pytest.mark.parametrize("has_document", [True, False])
def test_after_the_supervisor_hangs(
    place: Place, rcyaml: Rcyaml, robot: Callable[..., str], monkeypatch: pytest.MonkeyPatch, does_keeper_hang: bool,
    has_document: bool,
) -> None:  # fmt: skip
    document = robot()
    assert rcyaml("deploy", "up", document).exit_code == 0
    monkeypatch.setattr(client, "_PATIENCE", 0.5)
    pid = place.pids()["base"]
    keeper, supervisor = place.keeper_and_supervisor()
    if not has_document:
        os.unlink(document)
    with hanging(supervisor, *([keeper] if does_keeper_hang else [])):
        for command in (["status"], ["logs"], ["down", "base"] if has_document else ["status"]):
            said = rcyaml("deploy", *command[:1], "Robot" if not has_document else document, *command[1:])
            assert said.exit_code == 1 and f"its supervisor (pid {supervisor}) does not answer" in said.stderr
            assert "`rcyaml deploy down` ends it" in said.stderr
        assert is_alive(pid) and rcyaml("deploy", "ls").stdout.count("running") == 1
        said = rcyaml("deploy", "down", document if has_document else "Robot")
    assert said.exit_code == 0 and "RC7007" in said.stderr and said.stdout == "base  stopped\n"
    assert not is_alive(pid) and not procfs.marked(place.folder)
    assert left(place) == [] and rcyaml("deploy", "ls").stdout == "no deployment is running\n"


def test_after_its_folder_was_moved(
    place: Place, rcyaml: Rcyaml, robot: Callable[..., str], tmp_path: Path
) -> None:  # fmt: skip
    document = Path(robot())
    assert rcyaml("deploy", "up", str(document)).exit_code == 0
    moved = tmp_path / "moved"
    moved.mkdir()
    for path in (document, tmp_path / "base.conf", tmp_path / ".rcyaml"):
        path.rename(moved / path.name)
    place.root = moved
    assert rcyaml("deploy", "down", str(moved / document.name)).exit_code == 0
    assert rcyaml("deploy", "ls").stdout == "no deployment is running\n"
    assert left(place) == []


def test_down_by_name_after_the_end_of_the_supervisor(
    place: Place, rcyaml: Rcyaml, robot: Callable[..., str], tmp_path: Path
) -> None:
    assert rcyaml("deploy", "up", robot()).exit_code == 0
    for pid in place.keeper_and_supervisor():
        os.kill(pid, signal.SIGKILL)
    place.wait_gone()
    (tmp_path / "robot.ddsl.yaml").unlink()
    assert rcyaml("deploy", "down", "Robot").exit_code == 0
    assert left(place) == [] and rcyaml("deploy", "ls").stdout == "no deployment is running\n"


def test_after_a_first_up_that_failed(place: Place, rcyaml: Rcyaml, robot: Callable[..., str]) -> None:
    assert rcyaml("deploy", "up", robot("exit 3")).exit_code == 1
    assert left(place) == []


def test_after_a_later_up_that_failed_a_rollback_works_with_the_same_token(
    place: Place, rcyaml: Rcyaml, robot: Callable[..., str]
) -> None:
    document = robot()
    assert rcyaml("deploy", "up", document).exit_code == 0
    token = protection.token_of(place.folder)
    assert rcyaml("deploy", "up", robot("exit 3")).exit_code == 1
    kept = f"{registered.private(place.folder)}/token", f"{place.folder}/state/history.json"
    assert sorted(left(place)) == sorted(os.path.relpath(path, place.root) for path in kept)
    assert rcyaml("deploy", "rollback", document).exit_code == 0
    assert protection.token_of(place.folder) == token
    assert rcyaml("deploy", "down", document).exit_code == 0
    assert left(place) == []


def test_after_a_failed_up_and_down_without_a_rollback(place: Place, rcyaml: Rcyaml, robot: Callable[..., str]) -> None:
    assert rcyaml("deploy", "up", robot()).exit_code == 0
    assert rcyaml("deploy", "up", robot("exit 3")).exit_code == 1
    assert rcyaml("deploy", "down", robot()).stdout == "Robot: nothing was running\n"
    assert left(place) == []


def test_at_the_end_of_an_attached_up(place: Place, rcyaml: Rcyaml, robot: Callable[..., str]) -> None:
    assert rcyaml("deploy", "up", robot()).exit_code == 0
    assert rcyaml("deploy", "down", robot()).exit_code == 0
    document = robot("sleep 1; exit 0")
    assert rcyaml("deploy", "up", document, "--attach").exit_code == 1
    until(lambda: left(place) == [], lambda: str(left(place)))


def test_down_of_one_name_keeps_what_a_rollback_needs(place: Place, rcyaml: Rcyaml, robot: Callable[..., str]) -> None:
    document = robot()
    assert rcyaml("deploy", "up", document).exit_code == 0
    assert rcyaml("deploy", "down", document, "base").exit_code == 0
    assert rcyaml("deploy", "rollback", document).exit_code == 0
    assert place.observe()["base"].is_alive


@pytest.mark.slow
@NEEDS_ICEGRID
def test_with_icegrid_after_a_power_cut_of_this_machine(
    place: Place, rcyaml: Rcyaml, robot: Callable[..., str], tmp_path: Path
) -> None:
    """Its nodes never come back by themselves, so that nobody waits for them."""
    pytest.importorskip("IceGrid", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    document = Path(robot(more="host: two"))
    hosts = "hosts: {one: 127.0.0.1, two: 127.0.0.2}\n"
    document.write_text(document.read_text() + "  arm: {program: sleep, args: ['600'], host: one}\n" + hosts)
    assert rcyaml("deploy", "up", str(document)).exit_code == 0
    kill_left(place.folder)
    assert rcyaml("deploy", "down", str(document)).stdout == "Robot: nothing was running\n"
    assert left(place) == [] and rcyaml("deploy", "ls").stdout == "no deployment is running\n"
    assert not [path for path in Path(place.folder).rglob("*") if path.name == "key.pem"]
    assert not procfs.marked(place.folder)
