"""CommonBehavior is known twice: as Slice, with which components are compiled, and as a module, with which they are
called."""

from __future__ import annotations

import re

from conftest import ROOT
from robocomp_yaml.emit import slice as target
from robocomp_yaml.wire.behavior import common_behavior


def plain(text: str) -> list[str]:
    """The words of Slice, without comments and directives."""
    text = re.sub(r"/\*.*?\*/|//[^\n]*|^#[^\n]*", "", text, flags=re.DOTALL | re.MULTILINE)
    return re.findall(r"[\w:]+|[^\w\s]", text)


def test_both_are_the_same() -> None:
    written = (ROOT / "templates" / "slice" / "CommonBehavior.ice").read_text()
    assert plain(target.text(common_behavior())) == plain(written)
