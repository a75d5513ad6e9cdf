"""Migrated components compile in either language: the Python ones are imported, a sample of the C++ ones is built."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from conftest import IS_LONG, in_long, needs_corpus
from cpp_programs import FAST, cmake, needs_cpp
from robocomp_yaml.cli import group
from robocomp_yaml.diag.diagnostic import ERROR
from robocomp_yaml.pipeline import analyse

pytestmark = [needs_corpus, pytest.mark.slow]

SHARE = 1 if IS_LONG else 4
"""One of so many components is imported."""

# Each in a fork: loaded types remain in a process, and importing Ice in each would be slow.
IMPORTS = """
import json, os, sys, traceback
import Ice
sys.dont_write_bytecode = True
for root in json.load(sys.stdin):
    sys.stdout.flush()
    if os.fork() == 0:
        sys.path[:0] = [root, root + "/src"]
        try:
            import specificworker, generated.component
        except BaseException:
            print(root, traceback.format_exc(), flush=True)
        os._exit(0)
    os.wait()
"""


def compiled(migrated: Path, language: str, folder: Path) -> dict[str, Path]:
    """Compile all components whose imports resolve in a language, and return their folders by the documents' names."""
    shutil.copytree(migrated / "yaml", folder)
    for document in folder.rglob("*.cdsl.yaml"):
        text = document.read_text(encoding="utf-8")
        document.write_text(re.sub(r"(?m)^language: .*$", f"language: {language}", text), encoding="utf-8")
    analysis = analyse([str(folder)])
    faulty = {d.span.file for d in analysis.diagnostics if d.severity == ERROR}
    wanted = {
        Path(linked.component.path)
        for linked in analysis.program.components.values()
        if not linked.broken and not faulty & {linked.component.path, *(m.module.path for m in linked.modules())}
    }
    result = CliRunner().invoke(group, ["compile", str(folder)])
    assert isinstance(result.exception, SystemExit), result.exception
    done = {path for path in wanted if (path.parent / "generated").is_dir()}
    assert wanted - done == set()
    assert len(done) > 150
    return {path.parent.name: path.parent for path in done}


def test_every_python_component_is_imported(migrated: Path, tmp_path: Path) -> None:
    pytest.importorskip("Ice")
    pytest.importorskip("PySide6")
    roots = sorted(map(str, compiled(migrated, "python", tmp_path / "python").values()))[::SHARE]
    run = subprocess.run([sys.executable, "-c", IMPORTS], input=json.dumps(roots), capture_output=True, text=True)
    assert (run.returncode, run.stdout, run.stderr) == (0, "", "")


@needs_cpp
@in_long
def test_a_sample_of_the_cpp_components_is_built(migrated: Path, tmp_path: Path) -> None:
    """Build the largest component without a window. Components with windows need Qt, and are in the tests of
    windows."""
    components = compiled(migrated, "cpp", tmp_path / "cpp")
    sizes = {
        name: len((root / "generated/genericworker.cpp").read_text(encoding="utf-8"))
        for name, root in components.items()
        if "gui:" not in "".join(path.read_text(encoding="utf-8") for path in root.glob("*.cdsl.yaml"))
    }
    root = components[max(sizes, key=lambda name: sizes[name])]
    cmake(root, *FAST)
    assert any((root / "bin").iterdir())
