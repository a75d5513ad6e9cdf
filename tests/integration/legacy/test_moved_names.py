"""Names that legacy files use without an import of the file that defines them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

Run = Callable[..., Result]
BASE = "module RoboCompBase { struct Pose { float x; }; exception Lost { string what; }; interface Base { void go(); }; };\n"
ROBOT = 'import "Base.idsl";\nmodule RoboCompRobot { interface Robot { RoboCompBase::Pose at(); }; };\n'
OTHER = "module RoboCompOther { struct Image { int w; }; };\n"


def camera(method: str, *imports: str) -> str:
    lines = "".join(f'import "{one}.idsl";\n' for one in imports)
    return f"{lines}module RoboCompCamera {{ interface Camera {{ {method}; }}; }};\n"


@pytest.mark.parametrize(("imports", "method", "written"), [
    (["Robot"], "void look(RoboCompRobot::Pose p)", "Base.Pose"),  # it moved to what Robot imports
    (["Robot"], "void look(Pose p)", "Base.Pose"),
    (["Base"], "void look(Pose p)", "Base.Pose"),
    (["Robot"], "void look() throws Lost", "Base.Lost"),
    (["Base"], "void look(RoboCompOther::Image i)", "Other.Image"),  # its module is known, but not imported
])  # fmt: skip
def test_a_type_is_written_as_its_only_definition(
    rcyaml: Run, tmp_path: Path, imports: list[str], method: str, written: str
) -> None:
    files = {"Base.idsl": BASE, "Robot.idsl": ROBOT, "Other.idsl": OTHER, "Camera.idsl": camera(method, *imports)}
    write_tree(tmp_path, files)
    result = rcyaml("migrate", ".")
    assert result.exit_code == 0 and f"written as {written}" in result.stdout, result.stdout
    text = (tmp_path / "Camera.idsl.yaml").read_text()
    assert written in text and written.split(".")[0] in text.splitlines()[2]
    assert rcyaml("check").exit_code == 0, rcyaml("check").stdout
    assert "RC50" not in rcyaml("migrate", ".").stdout.replace("RC5049", "")


@pytest.mark.parametrize(("files", "method"), [
    ({"Two.idsl": BASE.replace("Base", "Two"), "Robot.idsl": f'import "Two.idsl";\n{ROBOT}'}, "void look(Pose p)"),
    ({"Robot.idsl": ROBOT}, "void look(RoboCompRobot::Sound s)"),
    ({"Robot.idsl": ROBOT}, "void look(RoboCompOther::Pose p)"),  # Other exists, and has none
])  # fmt: skip
def test_nothing_is_guessed(rcyaml: Run, tmp_path: Path, files: dict[str, str], method: str) -> None:
    """Two files define the name, or none does."""
    write_tree(
        tmp_path, {"Base.idsl": BASE, "Other.idsl": OTHER, "Camera.idsl": camera(method, "Robot", "Other"), **files}
    )
    result = rcyaml("migrate", ".")
    assert "RC5010" in result.stdout and "RC5049" not in result.stdout, result.stdout


MAPPER = 'import "Robot.idsl";\nComponent Mapper {{ Communications {{ {} }}; language python; }};\n'


@pytest.mark.parametrize("ports", ["requires Base, Robot;", "implements Base;", "requires Robot, Base, Base;"])
@pytest.mark.parametrize("is_elsewhere", [False, True])
@pytest.mark.parametrize("is_migrated", [False, True])
def test_an_interface_of_an_import_of_an_import(
    rcyaml: Run, tmp_path: Path, ports: str, *, is_elsewhere: bool, is_migrated: bool
) -> None:
    """In the repository, or in a folder of `-I`; both may be migrated already."""
    home = "elsewhere" if is_elsewhere else "robot/interfaces"
    files = {f"{home}/Base.idsl": BASE, f"{home}/Robot.idsl": ROBOT}
    write_tree(tmp_path, {**files, "robot/mapper/mapper.cdsl": MAPPER.format(ports)})
    if is_migrated:
        assert rcyaml("migrate", home.partition("/")[0]).exit_code == 0
    result = rcyaml("migrate", "robot", *(["-I", "elsewhere"] if is_elsewhere else []))
    assert result.exit_code == 0 and "warning[RC5048]: 'Base' is in Base" in result.stdout, result.stdout
    assert "imports: [Robot, Base]" in (tmp_path / "robot/mapper/mapper.cdsl.yaml").read_text()
    compiled = rcyaml("compile", "robot")
    assert compiled.exit_code == 0, compiled.stdout


def test_an_import_that_is_there_is_not_added(rcyaml: Run, tmp_path: Path) -> None:
    text = 'import "Base.idsl";\n' + MAPPER.format("requires Base, Robot;")
    write_tree(tmp_path, {"Base.idsl": BASE, "Robot.idsl": ROBOT, "m/m.cdsl": text})
    assert "RC5048" not in rcyaml("migrate", ".").stdout
