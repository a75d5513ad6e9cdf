"""docs/diagnostics.md is the table of codes as a page; --update-golden writes it."""

from __future__ import annotations

import pytest

from conftest import ROOT
from robocomp_yaml.commands.explain import summary
from robocomp_yaml.diag.codes import table

PAGE = ROOT / "docs" / "diagnostics.md"
HEAD = """# Diagnostics

Every code with its meaning; `rcyaml explain CODE` shows examples too, a wrong one and a right one. The severity of a
code can be changed for a workspace, under `lint:` in its `rcyaml.yaml`.
"""


def page() -> str:
    parts = [HEAD]
    for row in table().values():
        message = summary(row).replace("|", "\\|")
        parts.append(f"## {row.id}\n\n*{row.severity}*: {message}\n\n{row.why}\n")
    return "\n".join(parts)


def test_the_page_is_the_table(request: pytest.FixtureRequest) -> None:
    if request.config.getoption("--update-golden"):
        PAGE.write_text(page(), encoding="utf-8")
    assert PAGE.read_text(encoding="utf-8") == page()
