"""Real managers and launchers: XML to DDSL to XML is equal, the ledger is complete, and the documents are valid."""

from __future__ import annotations

import json
import shutil
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from conftest import CORPUS, needs_corpus
from rcmanager_facts import facts
from robocomp_yaml.cli import group
from robocomp_yaml.emit.exports import export
from robocomp_yaml.network.network import Network
from robocomp_yaml.pipeline import analyse

pytestmark = needs_corpus
MANAGERS = sorted((CORPUS / "rcmanager").glob("*.xml")) if CORPUS.is_dir() else []
LAUNCHERS = sorted((CORPUS / "launcher").glob("*.toml")) if CORPUS.is_dir() else []


def migrated(file: Path, folder: Path) -> tuple[Result, Path, dict[str, int]]:
    """Return the run, its document, and the number of lines of each class."""
    source = folder / file.name
    shutil.copyfile(file, source)
    result = CliRunner().invoke(group, ["migrate", str(source), "--report", str(folder / "ledger.json")])
    lines = json.loads((folder / "ledger.json").read_text(encoding="utf-8"))["files"][0]["lines"]
    return result, source.with_suffix(".ddsl.yaml"), lines


def network(document: Path) -> Network:
    """Return the document's network, which has no errors: what a manager accepted can be planned."""
    analysis = analyse([str(document)])
    errors = [diagnostic.code for diagnostic in analysis.diagnostics if diagnostic.severity == "error"]
    assert errors == []
    return analysis.networks[str(document.resolve())]


@pytest.mark.parametrize("file", MANAGERS, ids=lambda file: file.stem)
def test_a_manager_and_back(file: Path, tmp_path: Path) -> None:
    result, document, lines = migrated(file, tmp_path)
    assert result.exit_code == 0, result.output
    (text,) = export(network(document), "rcmanager").values()
    assert facts(text.encode()) == facts(file.read_bytes())
    assert lines["total"] == len(file.read_text(encoding="utf-8").splitlines())
    assert lines["lost"] == lines["refused"] == 0 and sum(lines.values()) == 2 * lines["total"]


@pytest.mark.parametrize("file", LAUNCHERS, ids=lambda file: file.stem)
def test_a_launcher(file: Path, tmp_path: Path) -> None:
    result, document, lines = migrated(file, tmp_path)
    assert result.exit_code == 0, result.output
    assert lines["lost"] == lines["refused"] == 0 and sum(lines.values()) == 2 * lines["total"]
    started = tomllib.loads(file.read_text(encoding="utf-8"))["components"]
    made = network(document)
    assert list(made.processes) == [component["name"] for component in started]
    for component, process in zip(started, made.processes.values(), strict=True):
        home = Path(component["cwd"]).expanduser()
        program, *arguments = component["cmd"].split()
        assert process.cwd == str(home)
        assert process.command == (str(home / program), *arguments)
        (endpoint,) = process.endpoints
        assert component["ice_name"].startswith(f"{endpoint.interface}:tcp")
        assert component["ice_name"].endswith(f"-p {endpoint.port}")


def test_every_comment_of_a_manager_is_kept(tmp_path: Path) -> None:
    file = next(file for file in MANAGERS if file.stem == "viriato__etcSim__etcSim__simple")
    _, document, _ = migrated(file, tmp_path)
    text = document.read_text(encoding="utf-8")
    source = file.read_text(encoding="utf-8")
    for comment in source.split("<!--")[1:]:
        for line in comment.partition("-->")[0].splitlines():
            assert line.strip() in text
