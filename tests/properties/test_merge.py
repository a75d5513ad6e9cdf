"""Random edits of a user against random changes of the interfaces, in each language: no line of the user is lost, what
comes out is code and has all methods, and where that cannot be, nothing is written. 200 in each run of the tests;
RCYAML_CASES=500 makes it 1,000."""

from __future__ import annotations

import ast
import re
import shutil
import warnings
from collections import Counter
from pathlib import Path
from random import Random

import pytest

from random_components import changed, plan, random_model
from random_edits import Files, edited
from robocomp_yaml.diag.codes.specific import CONFLICT
from robocomp_yaml.diag.diagnostic import has_errors
from robocomp_yaml.emit.build import Build
from robocomp_yaml.emit.specific import threeway
from robocomp_yaml.emit.specific.reading import read
from robocomp_yaml.emit.specific.review import review
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.transactions import writer
from robocomp_yaml.transactions.plan import RootPlan
from verdicts import CASES

pytestmark = pytest.mark.processes  # by git

CHUNKS, PAIRS, EDITS = 20 if CASES > 200 else 10, 10, max(CASES // 100, 1)
REFUSED = 0.25  # of all merges, at most: what two sides changed can be too much


@pytest.mark.slow
@pytest.mark.parametrize("language", ["python", "cpp", "java"])
@pytest.mark.parametrize("chunk", range(CHUNKS))
def test_no_line_is_lost(chunk: int, language: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if chunk % 4 == 3:
        monkeypatch.setattr(threeway, "_git", lambda: None)  # the library's turn
    refused = 0
    for pair in range(PAIRS):
        random = Random(f"{language} {chunk} {pair}")
        model = random_model(random)
        root = tmp_path / "robot"
        before = plan(model, language, tmp_path / "before", root)
        after = plan(changed(model, random), language, tmp_path / "after", root)
        for edit in range(EDITS):
            shutil.rmtree(root, ignore_errors=True)
            refused += _merge(before, after, Random(f"{language} {chunk} {pair} {edit}"), root)
    assert refused <= REFUSED * PAIRS * EDITS


def _merge(before: RootPlan, after: RootPlan, random: Random, root: Path) -> bool:
    """One user's edit, one merge; whether it was refused."""
    assert not has_errors(_write(before, merge=False))
    (root / "robot.cdsl.yaml").touch()
    skeleton = _sources(root)
    yours = edited(skeleton, random, python="src/specificworker.py" in skeleton)
    _put(root, yours)
    state = _sources(root / ".rcyaml")
    told = _write(after, merge=True)
    result = _sources(root)
    if has_errors(told):
        assert {diagnostic.code for diagnostic in told} == {CONFLICT.id}
        assert result == yours
        assert _sources(root / ".rcyaml") == state
        return True
    for path, text in yours.items():
        lost = Counter(_lines(text)) - Counter(_lines(skeleton.get(path, ""))) - Counter(_lines(result[path]))
        assert not lost, f"{path} lost {lost}"
        own = [line for line in _lines(text) if "mine" in line]
        assert [line for line in _lines(result[path]) if "mine" in line] == own
        assert _is_code(path, result[path]) or not _is_code(path, text)
    for path, text in _skeletons(after).items():
        for name in _methods(text):
            assert any(re.search(rf"\b{name}\(", found) for found in result.values()), f"{path} lacks {name}"
    if all(_is_code(path, text) for path, text in yours.items()):
        _assert_whole(result, after)
    assert not has_errors(_write(after, merge=True))
    assert _sources(root) == result, "a second merge changes nothing"
    return False


def _assert_whole(result: Files, after: RootPlan) -> None:
    """Each method is there once, in the class."""
    wanted = {path: _methods(text) for path, text in _skeletons(after).items()}
    if "src/specificworker.py" in result:
        tree = ast.parse(result["src/specificworker.py"])
        (class_,) = (node for node in tree.body if isinstance(node, ast.ClassDef) and node.name == "SpecificWorker")
        names = Counter(node.name for node in class_.body if isinstance(node, ast.FunctionDef))
        assert {name: names[name] for name in wanted["src/specificworker.py"]} == dict.fromkeys(
            wanted["src/specificworker.py"], 1
        )
    elif "src/SpecificWorker.java" in result:
        for name in wanted["src/SpecificWorker.java"]:
            text = result["src/SpecificWorker.java"]
            assert len(re.findall(rf"^ +public \w.*\b{name}\(", text, re.MULTILINE)) == 1, name
    else:
        header = result["src/specificworker.h"]
        sources = "\n".join(text for path, text in result.items() if path.endswith(".cpp"))
        for name in wanted["src/specificworker.h"]:
            assert len(re.findall(rf"^ +\w.*\b{name}\(", header, re.MULTILINE)) == 1, name
            assert len(re.findall(rf"^\w.*\bSpecificWorker::{name}\(", sources, re.MULTILINE)) == 1, name


def _methods(text: str) -> list[str]:
    return re.findall(r"^ +def (\w+)\(", text, re.MULTILINE) or re.findall(r"\b(\w+_\w+)\(.*;$", text, re.MULTILINE)


def _write(plan: RootPlan, *, merge: bool) -> list:
    own = review(Build([plan]), Disk(), merge=merge)
    changes = writer.prepare([plan], merges=own.merges)
    return [*own.diagnostics, *writer.commit(changes).diagnostics]


def _skeletons(plan: RootPlan) -> Files:
    return {file.path: file.text for file in plan.files if file.path.startswith("src/")}


def _sources(root: Path) -> Files:
    return {
        path.relative_to(root).as_posix(): path.read_bytes().decode()
        for path in sorted(root.rglob("*"))
        if path.is_file() and path.relative_to(root).parts[0] in ("src", "base")
    }


def _put(root: Path, files: Files) -> None:
    for path, text in files.items():
        (root / path).write_bytes(text.encode())


def _lines(text: str) -> list[str]:
    return [line.rstrip() for line in text.splitlines() if line.strip()]


def _is_code(path: str, text: str) -> bool:
    if path.endswith(".py"):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                compile(text, path, "exec")
        except SyntaxError:
            return False
        return True
    code = read(path, text)
    return code is not None and not code.faults
