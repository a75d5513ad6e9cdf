"""Real configs: Ice and `tomllib` read the same from the documents and the files, and each setting is in its
section."""

from __future__ import annotations

import csv
import json
import os
import re
import shutil
import tomllib
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from conftest import CORPUS, IS_LONG, needs_corpus
from robocomp_yaml.cli import group
from robocomp_yaml.parameters.layers.effective import Effective, effective
from robocomp_yaml.parameters.writing.properties import properties, property_text
from robocomp_yaml.parameters.writing.toml_text import toml_text
from robocomp_yaml.pipeline import analyse

pytestmark = needs_corpus
KINDS = ("config", "toml", "cdsl", "idsl", "jcdsl", "pdsl")
PROXY = re.compile(r'"?[^\s:"]+:\s*(?:tcp|udp|ssl|ws|wss|default)\b')
FAMILIES = re.compile(r"(?:Axis|Button|Params|Motor)_|Goal\d")


@pytest.fixture(scope="module")
def repositories(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The corpus as the repositories of its files."""
    folder = tmp_path_factory.mktemp("repositories")
    with (CORPUS / "manifest.csv").open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            if row["format"] in KINDS:
                target = folder / "old" / row["source_repo"].replace("/", "_") / row["source_path"]
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(CORPUS / row["path"], target)
    return folder


def migrated(folder: Path, name: str, *options: str) -> list[dict[str, Any]]:
    """The ledger of a run over all repositories."""
    report = folder / f"{name}.json"
    arguments = ["migrate", str(folder / "old"), "-o", str(folder / name), "--report", str(report), *options]
    result = CliRunner().invoke(group, arguments)
    assert isinstance(result.exception, SystemExit), result.output
    return json.loads(report.read_text(encoding="utf-8"))["files"]  # type: ignore[no-any-return]


@pytest.fixture(scope="module")
def ledger(repositories: Path) -> list[dict[str, Any]]:
    return migrated(repositories, "new")


@pytest.fixture(scope="module")
def exact(repositories: Path) -> list[dict[str, Any]]:
    return migrated(repositories, "exact", "--exact")


def values(documents: list[str]) -> dict[str, tuple[Any, Effective]]:
    """The effective values of each document."""
    analysis = analyse(tuple(documents), ())
    found = {}
    for document in documents:
        linked = analysis.program.values[os.path.realpath(document)]
        made, faults = effective(linked)
        assert made is not None, (document, faults)
        found[document] = linked, made
    return found


def by_ice(path: Path) -> dict[str, str]:
    Ice = pytest.importorskip("Ice", reason="the Ice module is not there")
    read = Ice.createProperties()
    read.load(str(path))
    return dict(read.getPropertiesForPrefix(""))


def squeezed(value: str) -> str:
    return re.sub(r"[ \t]*([,;])[ \t]*", r"\1", value)


@pytest.mark.parametrize("run", ["ledger", "exact"])
def test_ice_reads_the_same(run: str, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    files = [file for file in request.getfixturevalue(run) if file["format"] == "config" and file["outputs"]]
    assert len(files) > 570
    sources = {file["outputs"][0]: file["source"] for file in files}
    by_document = {os.path.realpath(document): Path(source) for document, source in sources.items()}
    different = []
    for document, (linked, made) in values(list(sources)[:: 1 if IS_LONG else 4]).items():
        sections, faults = properties(linked, made)
        assert faults == []
        target = tmp_path / "config"
        target.write_text(property_text(sections, "x", "y"), encoding="utf-8")
        got, meant = by_ice(target), {}
        for layer in linked.layers():  # a generic config comes before its specific one
            meant |= by_ice(by_document[os.path.realpath(layer.document.path)])
        if run == "ledger":
            got, meant = ({k: squeezed(v) for k, v in each.items()} for each in (got, meant))
        if got != meant:
            different.append((document, got.items() ^ meant.items()))
    assert different == []


def test_toml_reads_the_same(ledger: list[dict[str, Any]]) -> None:
    files = {file["outputs"][0]: file["source"] for file in ledger if file["format"] == "toml"}
    assert len(files) == 16
    for document, (linked, made) in values(list(files)).items():
        meant = tomllib.loads(Path(files[document]).read_text(encoding="utf-8"))
        assert tomllib.loads(toml_text(linked, made)) == meant, document


def test_every_line_is_accounted_for_and_none_is_lost(ledger: list[dict[str, Any]]) -> None:
    for file in ledger:
        if file["format"] in ("config", "toml", "jcdsl", "pdsl", "pconf"):
            text = Path(file["source"]).read_text(encoding="utf-8")
            classes = {name: count for name, count in file["lines"].items() if name != "total"}
            assert sum(classes.values()) == file["lines"]["total"] == len(text.splitlines()), file["source"]
            assert file["lines"]["lost"] == 0


def test_what_was_migrated_checks(repositories: Path, ledger: list[dict[str, Any]]) -> None:
    analysis = analyse((str(repositories / "new"),), ())
    errors = [d for d in analysis.diagnostics if d.severity == "error"]
    assert {d.code[:4] for d in errors} <= {"RC10", "RC11"}  # faults of interface files only


def test_negative_samples_are_rejected_or_reported(repositories: Path, ledger: list[dict[str, Any]]) -> None:
    status = {os.path.relpath(file["source"], repositories / "old"): file["status"] for file in ledger}
    with (CORPUS / "manifest.csv").open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if "NEGATIVE" in row["note"] and row["format"] == "config"]
    odd = {}
    for row in rows:
        source = os.path.join(row["source_repo"].replace("/", "_"), row["source_path"])
        if row["source_path"].endswith(".save"):
            assert source not in status  # an editor's backup is no config
        else:
            odd[row["path"]] = status[source]
    assert {name for name, how in odd.items() if how == "skipped"} == {
        "config/robolab__CGR__kinect_parameters.cfg", "config/robolab__CGR__localization_parameters.cfg"
    }  # fmt: skip
    assert {name for name, how in odd.items() if how == "converted"} <= {
        "config/robolab__CGR__config",
        "config/robolab__CGR__configRCIS",
    }  # fmt: skip -- these two are good Ice properties


def test_nearly_every_setting_is_in_its_section(ledger: list[dict[str, Any]]) -> None:
    all_, kept = Counter[str](), Counter[str]()
    sources = {file["outputs"][0]: file["source"] for file in ledger if file["format"] == "config" and file["outputs"]}
    for document, (linked, _) in values(list(sources)).items():
        verbatim = linked.document.root.data.get("properties", {})
        for key, value in by_ice(Path(sources[document])).items():
            kind = _kind(key, value)
            all_[kind] += 1
            kept[kind] += key in verbatim
    for kind, count in all_.items():
        assert kept[kind] <= count / 100, (kind, kept[kind], count)


def _kind(key: str, value: str) -> str:
    if key.startswith("Ice."):
        return "ice"
    if key.endswith(".Endpoints") or key.startswith("Endpoints."):
        return "endpoints"
    return "proxies" if PROXY.match(value) else "parameters"


def test_every_indexed_family_is_a_list_of_records(ledger: list[dict[str, Any]]) -> None:
    families = 0
    for file in ledger:
        if file["format"] != "config" or not file["outputs"]:
            continue
        rows = [key for key in by_ice(Path(file["source"])) if FAMILIES.search(key)]
        if rows:
            families += len({re.sub(r"\d+$", "", row) for row in rows})
            text = Path(file["outputs"][0]).read_text(encoding="utf-8")
            for row in rows:
                assert not re.search(rf"^ *{re.escape(row.split('.')[-1])}:", text, re.MULTILINE), (file["source"], row)
    assert families >= 30
