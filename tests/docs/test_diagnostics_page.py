"""docs/diagnostics.md is the table of codes as a page; --update-golden writes it."""

from __future__ import annotations

import re

import pytest

from conftest import ROOT
from robocomp_yaml.diag.codes import table

PAGE = ROOT / "docs" / "diagnostics.md"
HEAD = """# Diagnostics

Every code with its meaning; `rcyaml explain CODE` shows examples too, a wrong one and a right one. The severity of a
code can be changed for a workspace, under `lint:` in its `rcyaml.yaml`.
"""


def page() -> str:
    parts = [HEAD]
    for row in table().values():
        messages = [message.replace("|", "\\|") for message in row.messages]
        said = f": {messages[0]}" if len(messages) == 1 else ", one of:\n\n" + "\n".join(f"- {m}" for m in messages)
        parts.append(f"## {row.id}\n\n*{row.severity}*{said}\n\n{row.why}\n")
    return "\n".join(parts)


def test_the_page_is_the_table(request: pytest.FixtureRequest) -> None:
    if request.config.getoption("--update-golden"):
        PAGE.write_text(page(), encoding="utf-8")
    assert PAGE.read_text(encoding="utf-8") == page()


def test_no_entry_is_a_placeholder() -> None:
    """What a reader meets on the screen can be found: some of a message's words are the page's own."""
    for row in table().values():
        for message in row.messages:
            assert re.search(r"\b[a-z]{2}", message), f"{row.id}: {message}"
            assert "PROBLEM" not in message, row.id
