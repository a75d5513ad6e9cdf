"""Forms of windows: right, wrong and hostile ones."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from robocomp_yaml import pipeline
from robocomp_yaml.diag.codes import cdsl as codes
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic
from robocomp_yaml.emit.windows import text

BASES = ("QWidget", "QMainWindow", "QDialog")


def check(folder: Path, form: bytes | None, base: str = "QWidget") -> list[Diagnostic]:
    (folder / "any.cdsl.yaml").write_text(f"component: Any\nlanguage: cpp\ngui: {{toolkit: qt, base: {base}}}\n")
    if form is not None:
        (folder / "src").mkdir()
        (folder / "src" / "mainUI.ui").write_bytes(form)
    return list(pipeline.analyse([str(folder)]).diagnostics)


@pytest.mark.parametrize("base", BASES)
def test_generated_forms_are_right(tmp_path: Path, base: str) -> None:
    assert check(tmp_path, text(base, "Any").encode(), base) == []


@pytest.mark.parametrize("base", BASES)
def test_a_plain_widget_fits_all_bases(tmp_path: Path, base: str) -> None:
    assert check(tmp_path, text("QWidget", "Any").encode(), base) == []


def test_no_form_yet(tmp_path: Path) -> None:
    assert check(tmp_path, None) == []


LAUGHS = b'<!DOCTYPE ui [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]><ui><class>&b;</class></ui>'
OUTSIDE = b'<!DOCTYPE ui [<!ENTITY a SYSTEM "file:///etc/passwd">]><ui><class>&a;</class></ui>'


@pytest.mark.parametrize(
    ("form", "code"),
    [
        (b"", codes.NOT_A_FORM),
        (b"\x00\xff\x00\xff", codes.NOT_A_FORM),
        (b"<ui><class>guiDlg</class>", codes.NOT_A_FORM),
        (b'<?xml version="1.0" encoding="x-unheard"?><ui/>', codes.NOT_A_FORM),
        (b"<html/>", codes.NOT_A_FORM),
        (b"<ui><class>guiDlg</class></ui>", codes.NOT_A_FORM),
        (b'<ui><widget class="QWidget"/></ui>', codes.NO_DIALOG),
        (b'<ui><class>Form</class><widget class="QWidget"/></ui>', codes.NO_DIALOG),
        (b'<ui><class>guiDlg</class><widget class="QDialog"/></ui>', codes.OTHER_BASE),
        (LAUGHS, codes.FORM_WITH_ENTITIES),
        (OUTSIDE, codes.FORM_WITH_ENTITIES),
        (b"<ui><class>&none;</class></ui>", codes.NOT_A_FORM),
        (b"<ui>" + b"<a>" * 200_000, codes.NOT_A_FORM),
    ],
)
def test_each_fault_is_one_error(tmp_path: Path, form: bytes, code: codes.Code) -> None:
    begin = time.monotonic()
    errors = [said for said in check(tmp_path, form) if said.severity == ERROR]
    assert [said.code for said in errors] == [code.id]
    assert errors[0].span.file.endswith("mainUI.ui")
    assert time.monotonic() - begin < 10


def test_a_folder_instead_of_the_form(tmp_path: Path) -> None:
    (tmp_path / "src" / "mainUI.ui").mkdir(parents=True)
    assert [said.code for said in check(tmp_path, None)] == [codes.NOT_A_FORM.id]
