"""Mistakes in the paper's five tasks that are prone to errors are reported before anything runs. docs/mistakes.md lists
them, and is made of the same data and of what is reported; --update-golden writes it."""

from __future__ import annotations

import contextlib
import json
import os
import shlex
import shutil
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from conftest import ROOT, write_tree
from mistakes import CREATING, DEPLOYING, INTERFACES, MISTAKES, PARAMETERS, PROGRAM, PROXIES, WORKSPACE, Mistake
from robocomp_yaml.cli import group
from robocomp_yaml.diag.codes import row_of

PAGE = ROOT / "docs" / "mistakes.md"
TASKS = (CREATING, PROXIES, INTERFACES, PARAMETERS, DEPLOYING)
Reported = Callable[[Mistake], dict[str, Any]]


def run(folder: Path, *words: str) -> tuple[int, str]:
    with contextlib.chdir(folder):
        result = CliRunner().invoke(group, words)
    return result.exit_code, result.output


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The workspace without a mistake: compiled, with the user's code, and (as far as anybody can see) built."""
    folder = tmp_path_factory.mktemp("right") / "robot"
    code = {path: text for path, text in WORKSPACE.items() if "/src/" in path}
    write_tree(folder, {path: text for path, text in WORKSPACE.items() if path not in code})
    for texts in ({}, code):
        write_tree(folder, texts)
        assert run(folder, "-q", "compile")[0] == 0
    program = folder / PROGRAM
    program.parent.mkdir(exist_ok=True)
    program.write_text("#!/bin/sh\n", encoding="utf-8")
    program.chmod(0o755)
    return folder


@pytest.fixture(scope="module")
def reported(robot: Path, tmp_path_factory: pytest.TempPathFactory) -> Reported:
    """What is reported of a mistake at its location."""

    @cache
    def told(mistake: Mistake) -> dict[str, Any]:
        folder = tmp_path_factory.mktemp("wrong") / "robot"
        shutil.copytree(robot, folder, symlinks=True)
        for path, *texts in mistake.edits:
            if not texts:
                os.unlink(folder / path)
            elif len(texts) == 1:
                write_tree(folder, {path: texts[0]})
            else:
                before = (folder / path).read_text(encoding="utf-8")
                assert texts[0] in before
                (folder / path).write_text(before.replace(*texts, 1), encoding="utf-8")
        code, output = run(folder, *shlex.split(mistake.command), "--format", "json")
        shutil.rmtree(folder)
        found = json.loads(output)["diagnostics"]
        assert code == int(any(one["severity"] == "error" for one in found))
        places = [(one["code"], f"{one['file']}:{one['line']}:{one['column']}") for one in found]
        assert (mistake.code, mistake.at) in places, [
            (*place, one["message"]) for place, one in zip(places, found, strict=True)
        ]
        return dict(found[places.index((mistake.code, mistake.at))])

    return told


def test_nothing_is_wrong_without_a_mistake(robot: Path) -> None:
    assert run(robot, "check", "--code") == (0, "13 documents: nothing wrong\n")


@pytest.mark.parametrize("task", TASKS)
def test_each_task_has_eight_mistakes_and_more(task: str) -> None:
    assert sum(mistake.task == task for mistake in MISTAKES) >= 8
    assert {mistake.task for mistake in MISTAKES} == set(TASKS)


@pytest.mark.parametrize("mistake", MISTAKES, ids=lambda mistake: mistake.what)
def test_it_is_reported_before_anything_runs(mistake: Mistake, reported: Reported) -> None:
    assert reported(mistake)["message"]


HEAD = """\
# Mistakes

These mistakes are reported before anything runs. They are edits of one workspace, in the five tasks that are most
prone to errors. Each is reported by `rcyaml check`, unless another command is named. Tests make all of them, and write
this page (`tests/docs/mistakes.py`).

## What is checked, and when

| what | checked by |
|---|---|
| documents: shape, names, types, values, networks | `rcyaml check`, `compile`, and the editor (shape) |
| how code uses its worker: proxies, methods with their arguments and results, parameters, events and states, types and enumerators; in Python also imports of modules, members of structs, attributes of the worker, calls of the code's own functions, and slips such as a missing `self`; annotations are believed | `rcyaml check` and `compile`, with the documents as they are now |
| methods that other components call: missing, outdated, never called | the same |
| types of other expressions in Python | `rcyaml check --code`, with [ty](https://docs.astral.sh/ty/) |
| types of expressions in C++ and Java | the compilers: `rcyaml build` |
| programs that are missing or stale | `rcyaml check`, `deploy plan` and `deploy up` |
| libraries, programs on PATH, hosts | `rcyaml check --environment` |

Code is judged only if it is certain. Nothing is said about a name that the code itself sets, declares or contains as a
text (for `getattr` and `hasattr`), about classes with other bases, about code that catches the error by its name, near errors of syntax in C++ and
Java, and, in C++, about code in macros, in templates and in conditional parts of the preprocessor. `lint:` in `rcyaml.yaml`
switches a diagnostic off.

`--code` needs `pip install 'rcyaml[code]'`. It checks against the types of the documents as they are now, also before
they are compiled. Code for RoboComp's own tool (`compatibility: robocomp`) is not checked by it, because its modules
get their names at run time. A comment `# ty: ignore[RULE]` suppresses a finding.
"""


def row(mistake: Mistake, told: dict[str, Any]) -> str:
    link = f"[{mistake.code}](diagnostics/{row_of(mistake.code).page}.md#{mistake.code.lower()})"
    command = f" (`rcyaml {mistake.command}`)" if mistake.command != "check" else ""
    hint = f"; {told['hint']}" if told["hint"] else ""
    text = f"{told['message']}{hint}".replace("|", "\\|").replace("<", "&lt;")
    return f"| {mistake.what} | `{mistake.at}` | {link}{command}: {text} |\n"


def test_the_page_is_made_of_them(reported: Reported, request: pytest.FixtureRequest) -> None:
    page = HEAD
    for task in TASKS:
        page += f"\n## {task}\n\n| mistake | where | report |\n|---|---|---|\n"
        page += "".join(row(mistake, reported(mistake)) for mistake in MISTAKES if mistake.task == task)
    if request.config.getoption("--update-golden"):
        PAGE.write_text(page, encoding="utf-8")
    assert PAGE.read_text(encoding="utf-8") == page
