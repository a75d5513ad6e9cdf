"""`check` and `compile` compare the use of the worker in code with the documents, and fix misspelled names."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import read_tree, write_tree

Rcyaml = Callable[..., Result]
ARM = "module: RoboCompArm\ninterfaces: {Arm: {methods: {move: {in: {angle: float}}, stop: }}}\n"
PYTHON = """\
from generated.genericworker import GenericWorker


class SpecificWorker(GenericWorker):
    def initialize(self):
        self.log.info("hello")

    def compute(self):
        self.arm_proxy.move(1.5)
        self.arm_proxy.stop()
"""
HEADER = """\
#pragma once
#include "genericworker.h"
class SpecificWorker : public GenericWorker
{
public:
    void initialize();
    void compute();
};
"""
SOURCE = """\
#include "specificworker.h"
void SpecificWorker::initialize()
{
    arm_proxy->stop();
}
void SpecificWorker::compute()
{
    arm_proxy->move(1.5f);
}
"""
TREE = {
    "rcyaml.yaml": "interfaces: [.]\n",
    "Arm.idsl.yaml": ARM,
    "py/py.cdsl.yaml": "component: PyComp\nlanguage: python\nimports: [Arm]\nrequires: [Arm]\n",
    "cpp/cpp.cdsl.yaml": "component: CppComp\nlanguage: cpp\nimports: [Arm]\nrequires: [Arm]\n",
    "py/src/specificworker.py": PYTHON,
    "cpp/src/specificworker.h": HEADER,
    "cpp/src/specificworker.cpp": SOURCE,
}
STOPS = {("RC6302", "py/src/specificworker.py", 10), ("RC6302", "cpp/src/specificworker.cpp", 4)}


@pytest.fixture
def compiled(rcyaml: Rcyaml, tmp_path: Path) -> Path:
    write_tree(tmp_path, TREE)
    assert rcyaml("compile").exit_code == 0
    return tmp_path


def found(result: Result) -> set[tuple[str, str, int]]:
    return {(one["code"], one["file"], one["line"]) for one in json.loads(result.stdout)["diagnostics"]}


def test_check_and_compile_report_the_same(compiled: Path, rcyaml: Rcyaml) -> None:
    write_tree(compiled, {"Arm.idsl.yaml": ARM.replace("stop: ", "halt: ")})
    before = read_tree(compiled)
    checked = rcyaml("check", "--format", "json")
    assert (checked.exit_code, found(checked)) == (1, STOPS)
    assert read_tree(compiled) == before
    first, second = rcyaml("compile", "--format", "json"), rcyaml("compile", "--format", "json")
    assert [(one.exit_code, found(one)) for one in (first, second)] == [(1, STOPS)] * 2
    assert "def halt(" in (compiled / "py/generated/interfaces.pyi").read_text(encoding="utf-8")
    assert found(rcyaml("check", "--format", "json")) == STOPS


def test_only_changed_code_is_read_again(compiled: Path, rcyaml: Rcyaml, monkeypatch: pytest.MonkeyPatch) -> None:
    """What was reported about other components is still reported; what was changed or fixed is up to date."""
    write_tree(compiled, {"Arm.idsl.yaml": ARM.replace("stop: ", "halt: ")})
    rcyaml("compile")
    read: list[str] = []
    monkeypatch.setattr("robocomp_yaml.languages.cpp.usage.read", lambda *_: read.append("cpp"))
    write_tree(compiled, {"py/src/specificworker.py": PYTHON.replace("stop()", "halt()")})
    assert found(rcyaml("check", "--format", "json")) == {one for one in STOPS if one[1].startswith("cpp")}
    write_tree(compiled, {"py/src/specificworker.py": PYTHON.replace(".move(1.5)", ".mov(1.5)")})
    wrong = {("RC6302", "py/src/specificworker.py", line) for line in (9, 10)}
    assert found(rcyaml("check", "--format", "json")) == wrong | {one for one in STOPS if one[1].startswith("cpp")}
    assert read == []


def test_a_new_file_and_a_changed_document_are_noticed(compiled: Path, rcyaml: Rcyaml) -> None:
    assert found(rcyaml("check", "--format", "json")) == set()
    write_tree(compiled, {"py/src/specificworker.py": f"import more\n{PYTHON}", "py/src/more.py": "def f(:\n"})
    assert found(rcyaml("check", "--format", "json")) == {("RC6317", "py/src/more.py", 1)}
    write_tree(compiled, {"py/src/more.py": "x = 1\n", "py/py.cdsl.yaml": "component: PyComp\nlanguage: python\n"})
    assert {code for code, _, _ in found(rcyaml("check", "--format", "json"))} == {"RC6301"}


def test_names_are_fixed_in_code(compiled: Path, rcyaml: Rcyaml) -> None:
    write_tree(
        compiled,
        {
            "py/src/specificworker.py": PYTHON.replace("arm_proxy.stop", "Arm_proxy.stop"),
            "cpp/src/specificworker.cpp": SOURCE.replace("->move", "->moev"),
        },
    )
    diff = rcyaml("check", "--unsafe-fixes", "--diff").stdout
    assert "+        self.arm_proxy.stop()" in diff and "+    arm_proxy->move(1.5f);" in diff
    assert rcyaml("check", "--fix").stdout.startswith(
        "fixed  py/src/specificworker.py:10:14: write 'arm_proxy' (RC6301)"
    )
    assert rcyaml("check", "--unsafe-fixes").exit_code == 0
    tree = read_tree(compiled)
    assert (tree["py/src/specificworker.py"], tree["cpp/src/specificworker.cpp"]) == (PYTHON, SOURCE)


def test_a_workspace_may_switch_it_off(compiled: Path, rcyaml: Rcyaml) -> None:
    write_tree(compiled, {"Arm.idsl.yaml": ARM.replace("stop: ", "halt: ")})
    write_tree(compiled, {"rcyaml.yaml": "interfaces: [.]\nlint: {RC6302: warning}\n"})
    assert rcyaml("check").exit_code == 0
    write_tree(compiled, {"rcyaml.yaml": "interfaces: [.]\nlint: {RC6302: off}\n"})
    assert found(rcyaml("check", "--format", "json")) == set()


def test_code_that_is_not_text_is_not_read(compiled: Path, rcyaml: Rcyaml) -> None:
    (compiled / "py/src/more.py").write_bytes(b"\xff\xfe")
    (compiled / "py/src/loop").symlink_to(".")
    (compiled / "cpp/src/more.cpp").symlink_to("/nowhere")
    assert rcyaml("check").exit_code == 0
