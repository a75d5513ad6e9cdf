"""Deployments in a compile: nothing is generated from them, but a change makes the stamp stale."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree
from deployments import deployed
from robocomp_yaml import pipeline

TEXT = "components:\n  speech: {component: speech, config: flat}\n  mouth: {component: mouth}\n"


@pytest.fixture
def runs(rcyaml: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[], bool]:
    """Compiles everything. Returns whether documents were read; the first run is complete."""
    write_tree(tmp_path, {**deployed(TEXT), "rcyaml.yaml": "", "speech/flat": "volume = 1\n"})
    read: list[object] = []
    analyse = pipeline.analyse

    def counted(*args: object, **options: object) -> object:
        read.append(args)
        return analyse(*args, **options)  # type: ignore[arg-type]

    monkeypatch.setattr("robocomp_yaml.api.workspace.analyse", counted)

    def compile_() -> bool:
        read.clear()
        result = rcyaml("compile", ".")
        assert result.exit_code == 0, result.output
        return bool(read)

    assert compile_()
    return compile_


def test_a_second_run_has_nothing_to_do(runs: Callable[[], bool]) -> None:
    assert not runs()


@pytest.mark.parametrize("path", ["robot.ddsl.yaml", "speech/flat"])
def test_a_change_makes_the_stamp_stale(runs: Callable[[], bool], tmp_path: Path, path: str) -> None:
    with (tmp_path / path).open("a", encoding="utf-8") as file:
        file.write("# more\n")
    assert runs() and not runs()


def test_a_new_executable_does_not_make_the_stamp_stale(runs: Callable[[], bool], tmp_path: Path) -> None:
    (tmp_path / "speech/bin/other").write_text("", encoding="utf-8")
    assert not runs()


def test_diagnostics_of_a_deployment_are_printed(
    runs: Callable[[], bool], rcyaml: Callable[..., Result], tmp_path: Path
) -> None:
    document = tmp_path / "robot.ddsl.yaml"
    document.write_text(document.read_text(encoding="utf-8").replace("  mouth:", "  #"), encoding="utf-8")
    result = rcyaml("compile", ".")
    assert result.exit_code == 1 and "error[RC4201]" in result.output
