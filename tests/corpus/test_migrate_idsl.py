"""Real interface files: the Slice of the migrated documents has the checksums of the original."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from conftest import CORPUS, needs_corpus
from corpus.slice_oracle import checksums
from robocomp_yaml.cli import group
from robocomp_yaml.emit import slice as slice_target
from robocomp_yaml.pipeline import analyse

DEBIAN = Path("/usr/share/ice/slice")
ICES_OWN = "RC1002"  # a user's module cannot be named Ice…, but the modules of Ice are


def _migrated(source: Path, folder: Path) -> None:
    result = CliRunner().invoke(group, ["migrate", str(source), "-o", str(folder)])
    assert not result.exception or isinstance(result.exception, SystemExit), result.output


def _emitted(folder: Path, slices: Path) -> list[Path]:
    """Return the Slice of every document without an error in it and its imports."""
    slices.mkdir()
    analysis = analyse([str(folder)])
    broken = {Path(d.span.file).resolve() for d in analysis.diagnostics if d.severity == "error" and d.code != ICES_OWN}
    files = []
    for linked in analysis.program.modules.values():
        if not any(Path(scope.module.path).resolve() in broken for scope in linked.closure()):
            file = slices / slice_target.file_name(linked)
            file.write_text(slice_target.text(linked), encoding="utf-8")
            files.append(file)
    return files


def _as_slice(text: str) -> str:
    """Return an IDSL text as Slice: imports become includes, everything else is kept."""
    include = re.sub(r'(?m)^\s*import\s+"(?:[^"\n]*/)?([^"/\n]+?)(?:\.idsl)?"\s*;', r'#include "\1.ice"', text)
    return "#pragma once\n" + include


@needs_corpus
def test_the_slice_of_the_corpus_has_the_originals_checksums(tmp_path: Path) -> None:
    pytest.importorskip("Ice", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    originals = tmp_path / "originals"
    originals.mkdir()
    for path in sorted((CORPUS / "idsl").glob("*.idsl")):
        (originals / f"{path.stem}.ice").write_text(_as_slice(path.read_text(encoding="utf-8")), encoding="utf-8")
    _migrated(CORPUS / "idsl", tmp_path / "yaml")
    emitted = _emitted(tmp_path / "yaml", tmp_path / "slice")

    expected = checksums(sorted(originals.glob("*.ice")), originals)
    got = checksums(sorted(emitted), tmp_path / "slice")
    taken = {name: sums for name, sums in expected.items() if sums is not None}
    assert len(taken) > 120
    assert {name: got.get(name) for name in taken} == taken


@pytest.mark.skipif(not DEBIAN.is_dir(), reason="Debian's Slice files are not installed (zeroc-ice-slice)")
def test_the_files_of_ice_keep_their_checksums(tmp_path: Path) -> None:
    """Those that are migrated, because they use only what IDSL has."""
    pytest.importorskip("Ice", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    _migrated(DEBIAN, tmp_path / "yaml")
    seen = []
    for path in sorted(DEBIAN.glob("*/*.ice")):
        document = tmp_path / "yaml" / path.parent.name / f"{path.stem}.idsl.yaml"
        if not document.exists():
            continue
        emitted = _emitted(document, tmp_path / f"slice-{path.parent.name}-{path.stem}")
        own = [file for file in emitted if file.name == path.name]
        if own:
            got = checksums(own, own[0].parent)[path.name]
            expected = checksums([path], DEBIAN)[path.name]
            assert got is not None and expected is not None
            missing = expected.keys() - got.keys()  # of a rejected include that is not used
            assert got == {name: digest for name, digest in expected.items() if name not in missing}, path
            assert not missing or "#include" not in own[0].read_text(encoding="utf-8"), path
            seen.append(path.name)
    assert {"PropertiesAdmin.ice", "SliceChecksumDict.ice", "UserAccountMapper.ice", "Version.ice"} <= set(seen)
