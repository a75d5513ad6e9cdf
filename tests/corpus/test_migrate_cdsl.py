"""Real component files: their lists keep order and repetitions, and their documents are valid."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

from click.testing import CliRunner
from ruamel.yaml import YAML

from conftest import CORPUS, needs_corpus
from robocomp_yaml.cli import group
from robocomp_yaml.pipeline import analyse

LISTS = {"implements": "implements", "requires": "requires", "publishes": "publishes", "subscribesTo": "subscribes"}
REFUSED = {"robocomp__Comp1", "robocomp__Comp5"}  # `xxx` before Communications, `languadfgdfge cpp`
DESERVED = {  # rejected by the Slice compiler in the originals, too
    "RC1005": {"OpenposeBodyData"},
    "RC1010": {"CameraBus", "CloudPrimitives", "FaceRecognition", "Kinect", "MSKFace", "RobotTrajectory"},
}


def _ledger(migrated: Path) -> list[dict]:  # type: ignore[type-arg]
    return json.loads((migrated / "ledger.json").read_text(encoding="utf-8"))["files"]


def _said(text: str) -> tuple[dict[str, list[str]], list[str]]:
    """Return the lists and imports of a component file, read with regular expressions only."""
    bare = re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)
    lists: dict[str, list[str]] = {}
    stop = "|".join(LISTS)
    for clause in re.finditer(rf"\b({stop})\b((?:(?!\b(?:{stop})\b)[^;}}])*)", bare):
        names = [name.split("(")[0].strip() for name in clause[2].split(",")]
        lists.setdefault(LISTS[clause[1]], []).extend(name for name in names if name)
    paths = re.findall(r'import\s+"([^"]+)"', bare)
    stems = [path.split("/")[-1].removesuffix(".idsl") for path in paths]
    return lists, list(dict.fromkeys(stems))


def _interface(entry: object) -> str:
    """Return the interface of an entry of a list."""
    value = next(iter(entry.values())) if isinstance(entry, dict) else entry
    return value["interface"] if isinstance(value, dict) else str(value)


@needs_corpus
def test_only_unreadable_files_are_rejected(migrated: Path) -> None:
    refused = {Path(entry["source"]).stem for entry in _ledger(migrated) if entry["status"] == "refused"}
    assert refused == REFUSED | {"UrsusArm"}  # an enumerator twice in one enum
    assert not any(entry["lines"]["lost"] for entry in _ledger(migrated))


@needs_corpus
def test_the_lists_keep_order_and_multiplicity(migrated: Path) -> None:
    compared = 0
    for path in sorted((migrated / "source/components").glob("*/*.cdsl")):
        if path.stem in REFUSED:
            continue
        document = migrated / "yaml/components" / path.parent.name / f"{path.stem}.cdsl.yaml"
        data = YAML(typ="safe").load(document.read_text(encoding="utf-8"))
        lists, imports = _said(path.read_text(encoding="utf-8"))
        got = {key: [_interface(entry) for entry in data[key]] for key in LISTS.values() if key in data}
        assert got == {key: names for key, names in lists.items() if names}, path
        assert [name.lower() for name in data.get("imports", [])] == [name.lower() for name in imports], path
        names = [next(iter(entry)) if isinstance(entry, dict) else entry for entry in data.get("requires", [])]
        assert len(names) == len(set(names)), path
        compared += len(got)
    assert compared > 350


@needs_corpus
def test_documents_have_only_the_errors_of_their_sources(migrated: Path) -> None:
    errors = [d for d in analyse([str(migrated / "yaml")]).diagnostics if d.severity == "error"]
    undeserved = [
        d for d in errors if Path(d.span.file).name.removesuffix(".idsl.yaml") not in DESERVED.get(d.code, set())
    ]
    assert undeserved == []


@needs_corpus
def test_every_line_is_in_the_ledger(migrated: Path) -> None:
    for entry in _ledger(migrated):
        lines = dict(entry["lines"])
        total = lines.pop("total")
        assert total == sum(lines.values())
        assert total == len(Path(entry["source"]).read_text(encoding="utf-8").splitlines())


@needs_corpus
def test_every_word_of_every_comment_is_kept(migrated: Path) -> None:
    markup = re.compile(r"[\\@](?:brief|struct|interface|enum|namespace|exception|class)\b")
    for entry in _ledger(migrated):
        if not entry["outputs"]:
            continue
        source = Path(entry["source"]).read_text(encoding="utf-8")
        written = re.findall(r"\w+", Path(entry["outputs"][0]).read_text(encoding="utf-8"))
        known = set(written)
        for comment in re.findall(r"//[^\n]*|/\*.*?\*/", re.sub(r'"[^"\n]*"', '""', source), flags=re.DOTALL):
            missing = [word for word in re.findall(r"\w+", markup.sub("", comment)) if word not in known]
            assert not missing, (entry["source"], comment)


@needs_corpus
def test_a_second_run_changes_nothing(migrated: Path) -> None:
    before = {path: path.stat().st_mtime_ns for path in (migrated / "yaml").rglob("*") if path.is_file()}
    CliRunner().invoke(group, ["migrate", str(migrated / "source"), "-o", str(migrated / "yaml")])
    assert {path: path.stat().st_mtime_ns for path in (migrated / "yaml").rglob("*") if path.is_file()} == before


@needs_corpus
def test_the_samples_marked_as_wrong_are_rejected_or_reported(migrated: Path) -> None:
    status = {Path(entry["source"]).stem: entry["status"] for entry in _ledger(migrated)}
    with (CORPUS / "manifest.csv").open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["format"] in ("idsl", "cdsl")]
    for row in rows:
        if "NEGATIVE" in row["note"]:
            assert status[Path(row["path"]).stem] in ("refused", "warned"), row
