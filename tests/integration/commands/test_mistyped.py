"""An unknown command is reported in the same way at every level, with a command that works."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

Rcyaml = Callable[..., Result]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("compil", "unknown command 'compil'; did you mean 'compile'?"),
        ("deploy pln", "unknown command 'deploy pln'; did you mean 'deploy plan'?"),
        ("deploy staus x.ddsl.yaml", "unknown command 'deploy staus'; did you mean 'deploy status'?"),
        ("config sett a b", "unknown command 'config sett'; did you mean 'config set'?"),
        ("new componnent", "unknown command 'new componnent'; did you mean 'new component'?"),
        ("deploy xyzzy", "unknown command 'deploy xyzzy'; known are plan, up, "),
        ("xyzzy", "unknown command 'xyzzy'\n"),
        ("logs -f", "unknown command 'logs'; did you mean 'deploy logs'?"),
        ("export", "unknown command 'export'; did you mean 'config export' or 'deploy export'?"),
        ("interface Arm", "unknown command 'interface'; did you mean 'new interface'?"),
        ("deploy --pln", "No such option '--pln'"),
    ],
)
def test_unknown_commands(words: str, message: str, rcyaml: Rcyaml) -> None:
    result = rcyaml(*words.split())
    assert result.exit_code == 2 and message in result.stderr, result.stderr


@pytest.mark.parametrize("name", ["robot_ddsl.yaml", "robotddsl.yaml", "robot.cdsl.yaml", "robot.ddsl.yml"])
def test_a_picture_is_of_a_deployment(name: str, rcyaml: Rcyaml, tmp_path: Path) -> None:
    write_tree(tmp_path, {name: "deployment: Robot\ncomponents: {base: {program: sh}}\n"})
    result = rcyaml("graph", name)
    assert result.exit_code == 2
    assert f"'{name}' is neither a deployment document (NAME.ddsl.yaml) nor a folder" in result.stderr
