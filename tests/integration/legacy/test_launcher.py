"""Launchers as deployments: order, comments, and files that are not launchers."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

Run = Callable[..., Result]
SUB = """# The simulation.
[[components]]
name = "bridge"
cwd = "~/robocomp/bridge"   # from git
cmd = "bin/Bridge etc/config"
ice_name = "Bridge:tcp -h localhost -p 10006"

#[[components]]
#name = "camera"
#ice_name = "Camera:tcp -p 1

[[components]]
name = "helios"
cwd = "/opt/lidar"
cmd = "bin/lidar.py"
ice_name = "Lidar3D:tcp -h localhost -p 10098"
"""


def test_a_launcher(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"sub.toml": SUB})
    result = rcyaml("-q", "migrate", "sub.toml")
    assert result.output == ""
    assert (
        (tmp_path / "sub.ddsl.yaml").read_text(encoding="utf-8").split("\n", 1)[1]
        == """
# The simulation.
deployment: sub
components:
  bridge:
    program: bin/Bridge
    cwd: ~/robocomp/bridge  # from git
    args: [etc/config]
    endpoints: {Bridge: tcp -p 10006}

  # [[components]]
  # name = "camera"
  # ice_name = "Camera:tcp -p 1

  helios:
    program: bin/lidar.py
    cwd: /opt/lidar
    endpoints: {Lidar3D: tcp -p 10098}
"""
    )


def test_the_home_folder_is_resolved(rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path / "me"))
    write_tree(tmp_path, {"sub.toml": SUB, "me/robocomp/bridge/bin/Bridge": "x"})
    rcyaml("migrate", "sub.toml")
    said = rcyaml("check", "sub.ddsl.yaml").output
    assert "/opt/lidar/bin/lidar.py" in said and "no " + str(tmp_path / "me/robocomp/bridge/bin/Bridge") not in said


def test_the_content_decides_the_kind_of_a_toml_file(rcyaml: Run, tmp_path: Path) -> None:
    config = "[Endpoints]\nLaser = 'tcp'\n"
    other = "[a]\nb = 1\n"
    write_tree(tmp_path, {"etc/config.toml": config, "etc/sub.toml": SUB, "config2.toml": SUB, "x.toml": other})
    assert rcyaml("migrate", ".").exit_code == 0
    made = {path.name for path in tmp_path.rglob("*.yaml") if not path.name.endswith("pdsl.yaml")}
    assert made == {"rcyaml.yaml", "config.toml.config.yaml", "sub.ddsl.yaml", "config2.ddsl.yaml"}


def test_components_of_one_name(rcyaml: Run, tmp_path: Path) -> None:
    """A launcher starts both."""
    write_tree(tmp_path, {"sub.toml": SUB + '[[components]]\nname = "bridge"\ncwd = "/opt"\ncmd = "./x"\n'})
    result = rcyaml("migrate", "sub.toml")
    assert result.exit_code == 0 and "'bridge' is the name of another one" in result.output, result.output
    assert "  bridge_2:\n    program: ./x" in (tmp_path / "sub.ddsl.yaml").read_text(encoding="utf-8")


@pytest.mark.parametrize(("text", "code"), [
    (SUB + '[[components]]\ncmd = "x"\n', "RC5004"),
    (SUB + "[[components]]\nname = 3\n", "RC5004"),
    (SUB + "[other]\na = 1\n", "RC5004"),
    (SUB + "[[components]]\nname = 'a'\ncolour = 'red'\n", "RC5004"),
    (SUB + "[[components]]\nname = 'a'\nname = 'b'\n", "RC5003"),
])  # fmt: skip
def test_rejected_files(rcyaml: Run, tmp_path: Path, text: str, code: str) -> None:
    write_tree(tmp_path, {"sub.toml": text})
    result = rcyaml("migrate", "sub.toml")
    assert result.exit_code == 1 and f"error[{code}]" in result.output, result.output
    assert not (tmp_path / "sub.ddsl.yaml").exists()
    assert "[other]" not in text or result.output.count("error[") == 1


@pytest.mark.parametrize(
    "lines",
    [
        'cwd = "/opt/a\\nb"\ncmd = "bin/a"',
        'cwd = "/opt/a"\ncmd = "\'bin/a\\u001bb\' x"',
        'cwd = "/opt"\ncmd = "bin/a"\nice_name = "room/lamp:tcp -p 10003"',
        'cwd = "/opt"\ncmd = "bin/a"\nice_name = "lamp:tcp -p 10003 -q"',
        'cwd = "/opt"\ncmd = "bin/a"\nice_name = "lamp:tcp -p 10003 --sourceAddress 127.0.0.1"',
        'cwd = "/opt"\ncmd = "bin/a"\nice_name = "lamp:tcp -p 10003 -r \'/a\\nb\'"',
        'cwd = "/opt"\ncmd = "bin/a \'x\\ny\'"\nice_name = "lamp:ws -p 10003 -t 5 -z -r \\"/a b\\""',
    ],
)
@pytest.mark.parametrize("name", ["lamp", "l" * 300])
def test_odd_texts_become_valid_documents(rcyaml: Run, tmp_path: Path, name: str, lines: str) -> None:
    (tmp_path / "robot.toml").write_text(f'[[component]]\nname = "{name}"\n{lines}\n', encoding="utf-8")
    assert rcyaml("migrate", "robot.toml").exit_code == 0
    result = rcyaml("check", "--format", "json", ".")
    assert result.exit_code == 0, result.output
