"""Which modules `import robocomp_yaml.api` loads, and which ones common commands do not."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from conftest import ROOT, write_tree

UNUSED = {
    "check.flat.configs", "check.pdsl", "check.secrets", "emit.specific.reading", "link.workspace_files",
    "parameters.layers", "parameters.resolution.resolve", "parameters.writing", "network.network", "source.parts",
    "api.building", "building.builder", "building.job", "deploy.outdated", "model.deployment",
}  # fmt: skip
"""Of what most components have not, of edits and of builds. A third of the time of a first compile are imports."""

UNUSED_BY_PROGRAMS = {
    "robocomp_yaml.addresses.flat_values", "robocomp_yaml.check.flat.configs", "robocomp_yaml.deploy.ice_call",
    "robocomp_yaml.deploy.outdated", "robocomp_yaml.parameters.json_schema",
    "robocomp_yaml.parameters.layers.effective", "robocomp_yaml.parameters.writing.properties",
    "robocomp_yaml.parameters.writing.write", "robocomp_yaml.semantics.spellings", "robocomp_yaml.wire.protocol",
    "ctypes", "dataclasses", "secrets",
}  # fmt: skip
"""Of parameters, flat configs and Ice, which only components have."""


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


def modules_of(command: str, folder: Path) -> set[str]:
    """The modules that are imported when a command of rcyaml has ended."""
    code = f"import sys; from robocomp_yaml.cli import group; group({command.split()}, standalone_mode=False)"
    ended = "; print('', *sys.modules, file=sys.stderr)"
    own = {**os.environ, "XDG_STATE_HOME": str(folder / "state")}  # with a list of deployments of its own
    done = subprocess.run(
        [sys.executable, "-c", code + ended], capture_output=True, text=True, check=True, cwd=folder, env=own
    )
    return set(done.stderr.split())


@pytest.mark.parametrize("command", ["deploy plan", "deploy status", "deploy up", "deploy down"])
def test_a_deployment_of_programs_loads_little(tmp_path: Path, command: str) -> None:
    write_tree(tmp_path, {"two.ddsl.yaml": "deployment: Two\ncomponents: {one: {program: sleep, args: ['60']}}\n"})
    try:
        assert UNUSED_BY_PROGRAMS & modules_of(command, tmp_path) == set()
    finally:
        modules_of("deploy down", tmp_path)


def test_a_list_of_deployments_loads_no_parser(tmp_path: Path) -> None:
    unused = {"asyncio", "jsonschema_rs", "ruamel.yaml", "robocomp_yaml.pipeline", "robocomp_yaml.source.composed"}
    assert unused & modules_of("deploy ls", tmp_path) == set()


def test_a_check_of_a_component_loads_nothing_that_writes(tmp_path: Path) -> None:
    write_tree(tmp_path, {"c.cdsl.yaml": "component: C\nlanguage: python\n"})
    unused = {"asyncio", "jinja2", "subprocess", "robocomp_yaml.transactions.writer", "robocomp_yaml.emit.build"}
    assert unused & modules_of("check", tmp_path) == set()
