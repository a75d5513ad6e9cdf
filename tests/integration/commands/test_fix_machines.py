"""`rcyaml check --fix` in SCXML: only the misspelled words change."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

Run = Callable[..., Result]
COMPONENT = "component: ArmComp\nlanguage: python\nstatemachine: arm.scxml\n"
MACHINE = """\
<?xml version="1.0"?>
<!-- \U0001f916 idle, moving -->
<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" initial="idle">
  <state id="idle"><!-- \U0001f916 --><transition event="go" type='external'
      target="moving"/></state>
  <state id="moving">
    <onentry><log label="a &amp; b"/></onentry>
    <transition event="stop" target="idle"/>
  </state>
</scxml>
"""
SAFE = {
    "the namespace": (' xmlns="http://www.w3.org/2005/07/scxml"', ""),
    "the only value": ('version="1.0" initial', 'version="2" initial'),
    "another case of an attribute": ('event="go"', 'Event="go"'),
    "another case of a value": ("'external'", "'External'"),
}
GUESSES = {
    "a state": ('target="moving"', 'target="movng"'),
    "an attribute": ('event="go"', 'evnt="go"'),
    "an element": ("<transition", "<transiton"),
    "both tags of an element": ("onentry>", "onenty>"),
    "a value": ("'external'", "'extrnal'"),
}


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("option", ["--fix", "--unsafe-fixes"])
@pytest.mark.parametrize("what", [*SAFE, *GUESSES])
def test_misspelled_words_are_fixed(rcyaml: Run, tmp_path: Path, what: str, option: str, end: str) -> None:
    right = MACHINE.replace("\n", end)
    wrong = right.replace(*(SAFE | GUESSES)[what])
    assert wrong != right
    write_tree(tmp_path, {"arm.cdsl.yaml": COMPONENT})
    (tmp_path / "arm.scxml").write_bytes(wrong.encode())
    rcyaml("check", "--fix", *([option] if option != "--fix" else []))
    made = (tmp_path / "arm.scxml").read_bytes().decode()
    assert made == (right if option != "--fix" or what in SAFE else wrong)
