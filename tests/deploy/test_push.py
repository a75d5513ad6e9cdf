"""`rcyaml deploy push`, and what commands report of hosts that ssh does not reach: with a real sshd on loopback."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from conftest import write_tree
from ssh_host import NEEDS_SSHD, SshHost, ssh_host
from three_hosts import three_hosts

NETWORK = """\
deployment: Robot
hosts:
  arm: {{address: 127.0.0.1, path: {there}, ssh: {ssh}}}
components:
  grip: {{program: ./grip, args: [slowly]}}
  see: {{program: tools/see, cwd: .}}
  rest: {{program: sleep, args: ["60"]}}
"""
SCRIPT = "#!/bin/sh\nexec sleep 60\n"
pytestmark = [
    pytest.mark.slow,
    NEEDS_SSHD,
    pytest.mark.skipif(shutil.which("rsync") is None, reason="there is no rsync (Debian: rsync)"),
]


class Robot:
    """A deployment on one other host, whose files are in `there`."""

    def __init__(self, root: Path, host: SshHost) -> None:
        self.root, self.host, self.there = root, host, root.parent / "there"
        write_tree(root, {
            "robot.ddsl.yaml": NETWORK.format(there=self.there, ssh=host.ssh), "grip": SCRIPT, "tools/see": SCRIPT,
            "maps/floor.map": "the user's\n", "tools/notes.txt": "not needed\n",
        })  # fmt: skip
        for name in ("grip", "tools/see"):
            (root / name).chmod(0o755)

    def rcyaml(self, *words: str, code: int = 0, **environment: str) -> str:
        done = subprocess.run(
            [sys.executable, "-m", "robocomp_yaml", "deploy", *words], cwd=self.root, capture_output=True, text=True,
            check=False, env={**os.environ, "XDG_STATE_HOME": str(self.root.parent / "state"), **environment},
        )  # fmt: skip
        assert done.returncode == code, done.stdout + done.stderr
        return done.stdout + done.stderr

    def files(self) -> set[str]:
        return {str(path.relative_to(self.there)) for path in self.there.rglob("*") if path.is_file()}

    def change(self, old: str, new: str, name: str = "robot.ddsl.yaml") -> None:
        text = (self.root / name).read_text(encoding="utf-8")
        assert old in text
        (self.root / name).write_text(text.replace(old, new), encoding="utf-8")


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[Robot]:
    with ssh_host(tmp_path / "ssh") as host:
        yield Robot(tmp_path / "robot", host)


def test_a_push_brings_what_processes_need_and_a_second_one_nothing(robot: Robot) -> None:
    assert "would send 2 files" in robot.rcyaml("push", "--dry-run")
    assert not robot.there.exists()
    assert "sent 2 files" in robot.rcyaml("push")
    assert robot.files() == {"grip", "tools/see"}
    assert os.access(robot.there / "grip", os.X_OK)
    assert robot.rcyaml("push") == "arm  nothing to send, 2 files are up to date\n"
    assert robot.host.logins == 3, "one connection for each command"
    assert "missing" not in robot.rcyaml("probe")


def test_a_push_deletes_only_what_it_brought(robot: Robot) -> None:
    robot.rcyaml("push")
    write_tree(robot.there, {"grip.log": "written there\n", "tools/calibration": "measured there\n"})
    robot.change("  see: {program: tools/see, cwd: .}\n", "")
    assert "deleted 1 file" in robot.rcyaml("push")
    assert robot.files() == {"grip", "grip.log", "tools/calibration"}
    robot.change("  grip: {program: ./grip, args: [slowly]}\n", "")
    (robot.there / "grip").write_text("changed there\n", encoding="utf-8")
    assert "they stay, because they were changed there" in robot.rcyaml("push")
    assert "grip" in robot.files()


def test_a_file_that_was_there_already_is_never_deleted(robot: Robot) -> None:
    """Such as one in a folder that both machines share."""
    robot.there.mkdir()
    shutil.copy2(robot.root / "grip", robot.there / "grip")
    assert "sent 1 file" in robot.rcyaml("push")
    robot.change("  grip: {program: ./grip, args: [slowly]}\n", "")
    robot.rcyaml("push")
    assert "grip" in robot.files()


def test_what_was_changed_on_the_host_is_replaced_and_kept(robot: Robot) -> None:
    robot.rcyaml("push")
    for number in range(2):
        (robot.there / "grip").write_text(f"a repair at night, {number}\n", encoding="utf-8")
        assert "replaced what no push had brought" in robot.rcyaml("push")
        assert (robot.there / "grip").read_text(encoding="utf-8") == SCRIPT
    kept = [path.read_text(encoding="utf-8") for path in (robot.host.state / "rcyaml/replaced").rglob("grip")]
    assert sorted(kept) == ["a repair at night, 0\n", "a repair at night, 1\n"]


def test_only_changed_files_are_sent_and_only_of_the_named_processes(robot: Robot) -> None:
    robot.rcyaml("push")
    for name in ("grip", "tools/see"):
        robot.change("60", "61", name)
    assert "sent 1 file" in robot.rcyaml("push", "robot.ddsl.yaml", "see")
    assert (robot.there / "grip").read_text(encoding="utf-8") == SCRIPT
    told = json.loads(robot.rcyaml("push", "robot.ddsl.yaml", "arm", "--format", "json"))
    [arm] = told["hosts"]
    assert (arm["sent"], arm["unchanged"], arm["deleted"]) == ([f"{robot.there}/grip"], 1, [])


def test_a_program_that_lost_its_right_is_repaired(robot: Robot) -> None:
    robot.rcyaml("push")
    (robot.there / "grip").chmod(0o644)
    robot.rcyaml("push")
    assert os.access(robot.there / "grip", os.X_OK)


def test_another_kind_of_machine_is_refused_before_anything_is_sent(robot: Robot) -> None:
    arm64 = bytes.fromhex("7f454c460201010000000000000000000200b700") + bytes(44)
    (robot.root / "grip").write_bytes(arm64)
    told = robot.rcyaml("push", code=1)
    assert "RC7002" in told
    assert "is for ARM of 64 bits (aarch64), and the host 'arm' is" in told
    assert not robot.there.exists()
    robot.there.mkdir()
    shutil.copy2("/bin/true", robot.there / "grip")  # as if built there
    assert "built there" in robot.rcyaml("push")
    assert robot.files() == {"grip", "tools/see"}
    assert (robot.there / "grip").read_bytes() == Path("/bin/true").read_bytes()


def test_an_interrupted_push_continues(robot: Robot, tmp_path: Path) -> None:
    """Here `rsync` ends after its first file."""
    real = shutil.which("rsync")
    write_tree(tmp_path, {
        "bin/rsync": f'#!/bin/sh\ntr "\\000" "\\n" | head -n 1 | tr "\\n" "\\000" | {real} "$@"\necho cut >&2\nexit 12\n'
    })  # fmt: skip
    (tmp_path / "bin/rsync").chmod(0o755)
    told = robot.rcyaml("push", code=1, PATH=f"{tmp_path}/bin:{os.environ['PATH']}")
    assert "RC7072" in told
    assert len(robot.files()) == 1
    assert "sent 1 file" in robot.rcyaml("push")
    robot.change("  see: {program: tools/see, cwd: .}\n", "")
    robot.change("  grip: {program: ./grip, args: [slowly]}\n", "")
    assert "deleted 2 files" in robot.rcyaml("push"), "what came before the cut was brought, too"


def test_a_missing_rsync_is_reported(robot: Robot, tmp_path: Path) -> None:
    """Here and there: on the host, PATH has only some programs."""
    programs = tmp_path / "few"
    programs.mkdir()
    for name in ("bash", "head", "od", "tr", "sort", "xargs", "sha256sum", "cat", "ssh", "sh"):
        (programs / name).symlink_to(shutil.which(name) or name)
    assert "this machine has no rsync" in robot.rcyaml("push", code=1, PATH=str(programs))


@pytest.mark.parametrize(("change", "reason", "hint"), [
    (("known-hosts: ", "known-hosts: /nowhere"), "its key is unknown", "connect once with `ssh -p"),
    (("/key,", "/host_key,"), "login is not permitted", "must work without a password"),
    (("address: 127.0.0.1", "address: nowhere.invalid"), "its address cannot be resolved", "correct `address:`"),
    (("/key,", "/no_key,"), "the private key", "correct `ssh: {identity: …}`"),
    (("port: ", "port: 1 #"), "connection refused", "openssh-server"),
])  # fmt: skip
def test_hosts_that_ssh_does_not_reach(robot: Robot, change: tuple[str, str], reason: str, hint: str) -> None:
    old, new = change
    text = (robot.root / "robot.ddsl.yaml").read_text(encoding="utf-8")
    text = text.replace(old, new) if new != "port: 1 #" else re.sub(r"port: \d+", "port: 1", text)
    (robot.root / "robot.ddsl.yaml").write_text(text, encoding="utf-8")
    for command, code in (("push", "RC7072"), ("probe", "RC7010")):
        told = robot.rcyaml(command, code=1)
        assert code in told
        assert reason in told
        assert hint in told


def test_through_a_jump_host(tmp_path: Path) -> None:
    """Two real servers in network namespaces: only the first one reaches the second one, where the files go."""
    with three_hosts() as hosts:
        hosts.need_a_network("so nothing that only another host reaches")
        prefix, jump_at, target_at = hosts.prefix, hosts.addresses["head"], "10.97.0.3"
        for host, address in (("head", "10.97.0.2/24"), ("arm", f"{target_at}/24")):
            assert hosts.run(host, ["ip", "address", "add", address, "dev", "eth0"]).returncode == 0
        inside = {host: ["ip", "netns", "exec", f"{prefix}{host}"] for host in ("head", "arm")}
        with (
            ssh_host(tmp_path / "jump", jump_at, inside["head"]) as jump,
            ssh_host(tmp_path / "target", target_at, inside["arm"]) as target,
        ):
            shutil.copy(target.folder / "key.pub", jump.folder / "key.pub")
            known = target.folder / "known_hosts"
            known.write_text(known.read_text() + (jump.folder / "known_hosts").read_text())
            robot, by_jump = (
                Robot(tmp_path / "here", target),
                f"{target.ssh[:-1]}, jump: 'root@{jump_at}:{jump.port}'}}",
            )

            def rcyaml(*words: str, code: int = 0) -> str:
                done = hosts.run(
                    "onboard", [sys.executable, "-m", "robocomp_yaml", "deploy", *words], cwd=robot.root,
                    env={"XDG_STATE_HOME": str(tmp_path / "state")},
                )  # fmt: skip
                assert done.returncode == code, done.stdout + done.stderr
                return done.stdout + done.stderr

            robot.change("address: 127.0.0.1", f"address: {target_at}", "robot.ddsl.yaml")
            assert "cannot" in rcyaml("push", code=1), "nobody reaches it directly"
            robot.change(target.ssh, by_jump)
            said = rcyaml("push")
            assert "sent 2 files" in said and robot.files() == {"grip", "tools/see"}, said
            assert "nothing to send" in rcyaml("push")
            assert "grip" in rcyaml("probe")
            assert jump.logins and target.logins

            robot.change(f":{jump.port}'", ":1'")
            assert "or by the jump host on the way" in rcyaml("push", code=1)


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler (Debian: gcc)")
def test_shared_libraries_of_the_workspace_come_along(robot: Robot) -> None:
    """Also the library of a library; what nothing needs any more is deleted."""
    write_tree(robot.root, {
        "lib/inner.c": "int inner(void) { return 4; }\n",
        "lib/outer.c": "int inner(void); int outer(void) { return inner(); }\n",
        "main.c": "int outer(void); int main(void) { return outer(); }\n",
    })  # fmt: skip

    def build(*words: str) -> None:
        subprocess.run(["cc", *words], cwd=robot.root, check=True)

    build("-shared", "-fPIC", "lib/inner.c", "-o", "lib/libinner.so.1", "-Wl,-soname,libinner.so.1")
    build("-shared", "-fPIC", "lib/outer.c", "lib/libinner.so.1", "-o", "lib/libouter.so",
          "-Wl,-soname,libouter.so,-rpath,$ORIGIN")  # fmt: skip
    build("main.c", "lib/libouter.so", "-o", "grip", "-Wl,-rpath,$ORIGIN/lib", "-Wl,--allow-shlib-undefined")
    robot.rcyaml("push")
    assert robot.files() == {"grip", "tools/see", "lib/libouter.so", "lib/libinner.so.1"}
    assert subprocess.run([robot.there / "grip"], check=False).returncode == 4
    assert "nothing to send" in robot.rcyaml("push")
    (robot.root / "grip").write_text(SCRIPT)
    robot.rcyaml("push")
    assert robot.files() == {"grip", "tools/see"}
