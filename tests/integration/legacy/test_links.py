"""Repositories with links: a document is beside the file itself, and what is outside is only read."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

Run = Callable[..., Result]
ARM = "module RoboCompArm { interface Arm { void go(); }; };\n"
BOT = 'import "Arm.idsl";\nComponent bot { Communications { requires Arm; }; language python; };\n'


def documents(folder: Path) -> list[str]:
    """The documents below a folder, without those behind links."""
    found = (path for path in folder.rglob("*.yaml") if ".rcyaml" not in path.parts and path.name != "rcyaml.yaml")
    real = (path.relative_to(folder) for path in found if path == path.parent.resolve() / path.name)
    return sorted(str(path) for path in real)


@pytest.mark.parametrize(("link", "target"), [("aa", "zz"), ("aa", "zz/bot"), ("a.cdsl", "zz/bot/bot.cdsl"),
                                              ("zz/up", ".."), ("zz/bot/self", ".")])  # fmt: skip
def test_a_document_is_beside_the_file_itself(rcyaml: Run, tmp_path: Path, link: str, target: str) -> None:
    write_tree(tmp_path, {"zz/bot/bot.cdsl": BOT, "zz/Arm.idsl": ARM})
    (tmp_path / link).symlink_to(target)
    assert rcyaml("migrate", ".").exit_code == 0
    assert documents(tmp_path) == ["zz/Arm.idsl.yaml", "zz/bot/bot.cdsl.yaml"]
    assert rcyaml("compile").exit_code == 0


def test_a_link_to_nothing_is_skipped(rcyaml: Run, tmp_path: Path) -> None:
    """A submodule that was not cloned."""
    write_tree(tmp_path, {"bot.cdsl": BOT, "interfaces/Arm.idsl": ARM})
    (tmp_path / "interfaces/Leg.idsl").symlink_to("../core/Leg.idsl")
    (tmp_path / "core").symlink_to("nowhere")
    result = rcyaml("migrate", ".")
    assert result.exit_code == 0 and "note[RC0001]" in result.output, result.output


@pytest.mark.parametrize("target", ["../core", "../core/interfaces", "../core/interfaces/IDSLs"])
def test_a_folder_outside_is_only_read(rcyaml: Run, tmp_path: Path, target: str) -> None:
    """What is imported from it is migrated into the repository; its components are another repository's."""
    write_tree(tmp_path, {"robot/bot.cdsl": BOT, "core/interfaces/IDSLs/Arm.idsl": ARM, "core/x/x.cdsl": BOT})
    (tmp_path / "robot/lib").symlink_to(target)
    before = sorted((tmp_path / "core").rglob("*"))
    result = rcyaml("migrate", "robot")
    assert result.exit_code == 0 and result.output.count("note[RC5041]") == 1, result.output
    assert documents(tmp_path / "robot") == ["bot.cdsl.yaml", "interfaces/Arm.idsl.yaml"]
    assert sorted((tmp_path / "core").rglob("*")) == before
    assert rcyaml("compile", "robot").exit_code == 0
    assert "RC5023" not in rcyaml("migrate", "robot").output


def test_a_folder_outside_is_migrated_elsewhere(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"robot/bot.cdsl": BOT, "core/Arm.idsl": ARM})
    (tmp_path / "robot/lib").symlink_to("../core")
    assert rcyaml("migrate", "robot", "-o", "new").exit_code == 0
    assert documents(tmp_path / "new") == ["bot.cdsl.yaml", "lib/Arm.idsl.yaml"]
