"""A word that is no command is told in one way at every level, with a command that can be typed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

Rcyaml = Callable[..., Result]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("compil", "there is no command 'compil'; did you mean 'compile'?"),
        ("deploy pln", "there is no command 'deploy pln'; did you mean 'deploy plan'?"),
        ("deploy staus x.ddsl.yaml", "there is no command 'deploy staus'; did you mean 'deploy status'?"),
        ("config sett a b", "there is no command 'config sett'; did you mean 'config set'?"),
        ("new componnent", "there is no command 'new componnent'; did you mean 'new component'?"),
        ("deploy xyzzy", "there is no command 'deploy xyzzy'\n"),
        ("xyzzy", "there is no command 'xyzzy'\n"),
        ("logs -f", "there is no command 'logs'; did you mean 'deploy logs'?"),
        ("export", "there is no command 'export'; did you mean 'config export' or 'deploy export'?"),
        ("interface Arm", "there is no command 'interface'; did you mean 'new interface'?"),
        ("deploy --pln", "No such option '--pln'"),
    ],
)
def test_a_word_that_is_no_command(words: str, said: str, rcyaml: Rcyaml) -> None:
    result = rcyaml(*words.split())
    assert result.exit_code == 2 and said in result.stderr, result.stderr


@pytest.mark.parametrize("name", ["robot_ddsl.yaml", "robotddsl.yaml", "robot.cdsl.yaml", "robot.ddsl.yml"])
def test_a_picture_is_of_a_deployment(name: str, rcyaml: Rcyaml, tmp_path: Path) -> None:
    write_tree(tmp_path, {name: "deployment: Robot\ncomponents: {base: {program: sh}}\n"})
    result = rcyaml("graph", name)
    assert result.exit_code == 2
    assert f"'{name}' is no deployment document (NAME.ddsl.yaml), and no folder" in result.stderr
