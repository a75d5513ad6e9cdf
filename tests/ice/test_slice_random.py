"""Random modules with odd names: what our checks accept every compiler of Slice accepts, and what they refuse Slice
refuses too (but for what we refuse for reasons of our own)."""

from __future__ import annotations

from pathlib import Path

import pytest

from random_modules import Maker
from robocomp_yaml.check import check_documents
from robocomp_yaml.diag.codes import idsl as codes
from robocomp_yaml.diag.diagnostic import ERROR
from robocomp_yaml.emit import slice as target
from robocomp_yaml.link.program import LinkedModule, Program
from slice_compilers import complaints, needs_compilers

pytestmark = needs_compilers

# Slice takes some of these: interfaces by value (deprecated), numbers that change in silence; and of two definitions of
# one name our emitter writes one.
OURS_ALONE = {codes.NOT_A_TYPE.id, codes.MISFIT.id, codes.DUPLICATE_NAME.id}


# Words that slice2py and Ice.loadSlice stumble over, and our generated components do not.
IN_PYTHON_ALONE = {codes.PYTHON_WORD.id}


def _said(pair: list[LinkedModule]) -> set[str]:
    program = Program({linked.module.path: linked for linked in pair})
    said = list(check_documents(program))
    return {d.code for d in said if d.severity == ERROR or d.code in IN_PYTHON_ALONE}


def _written(pair: list[LinkedModule], number: int, folder: Path) -> list[str]:
    names = [target.file_name(linked).replace("Nn", str(number)) for linked in pair]
    for name, linked in zip(names, pair, strict=True):
        (folder / name).write_text(target.text(linked).replace("Nn", str(number)), encoding="utf-8")
    return names


@pytest.mark.parametrize("seed", range(3))
def test_what_we_accept_every_compiler_accepts(seed: int, tmp_path: Path) -> None:
    maker = Maker(seed, faults=0.01)
    pairs = [pair for pair in (maker.pair() for _ in range(120)) if not _said(pair)]
    names = [name for number, pair in enumerate(pairs) for name in _written(pair, number, tmp_path)]
    said = complaints(tmp_path, names)
    shown = [(tmp_path / name).read_text(encoding="utf-8") for name in list(said)[:1] if name in names]
    assert said == {}, "\n".join(shown)
    assert len(pairs) > 30


def test_what_rcyaml_rejects_slice_rejects(tmp_path: Path) -> None:
    maker = Maker(0, faults=0.03)
    refused = [(pair, said) for pair in (maker.pair() for _ in range(60)) if (said := _said(pair))]
    asked = [(pair, said) for pair, said in refused if not said & OURS_ALONE]
    assert len(asked) > 10
    for number, (pair, said) in enumerate(asked):
        names = _written(pair, number, tmp_path)
        assert complaints(tmp_path, names), (said, (tmp_path / names[1]).read_text(encoding="utf-8"))
