"""Which modules `import robocomp_yaml.api` loads, and which ones the first compile of a component does not."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from conftest import ROOT, write_tree

UNUSED = {
    "check.flat.configs", "check.pdsl", "check.secrets", "emit.specific.reading", "link.workspace_files",
    "parameters.layers", "parameters.resolution.resolve", "parameters.writing", "network.network", "source.parts",
}  # fmt: skip
"""Of what most components have not, and of edits. A third of the time of a first compile are imports."""


def test_the_library_loads_little() -> None:
    code = "import sys, robocomp_yaml.api; print(*(m for m in sys.modules if m.startswith('robocomp_yaml.')))"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT).stdout
    assert {name.split(".")[1] for name in out.split()} <= {"api", "diag", "registry"}


@pytest.mark.parametrize("language", ["python", "cpp"])
def test_a_first_compile_loads_little(tmp_path: Path, language: str) -> None:
    write_tree(
        tmp_path,
        {
            "Speech.idsl.yaml": "module: S\ninterfaces: {Speech: {methods: {say: {in: {text: string}}}}}\n",
            "speech.cdsl.yaml": f"component: C\nlanguage: {language}\nimports: [Speech]\nimplements: [Speech]\n",
        },
    )
    code = (
        "import sys; from robocomp_yaml import api; done = api.load().compile(output='out').apply();"
        "assert not done.diagnostics; print(*sys.modules)"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=tmp_path)
    assert {f"robocomp_yaml.{name}" for name in UNUSED} & set(run.stdout.split()) == set()
