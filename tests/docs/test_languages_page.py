"""The table in docs/languages.md is the table of languages; --update-golden writes it."""

from __future__ import annotations

import pytest

from conftest import ROOT
from robocomp_yaml import languages
from robocomp_yaml.languages.record import CAPABILITIES, USES, TargetLanguage

PAGE = ROOT / "docs" / "languages.md"


def rows() -> str:
    known = list(languages.table().values())
    head = ["", *(one.title for one in known)]
    lines = [head, ["---"] * len(head), ["`language:`", *(f"`{one.name}`" for one in known)]]
    lines += [[_key(key), *(_may(one, key) for one in known)] for key in CAPABILITIES]
    lines.append(["what runs", *(f"`{one.program.format(name='NAME')}`" for one in known)])
    lines.append(["built by", *(_build(one) for one in known)])
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _key(key: str) -> str:
    return f"`uses:` {key}" if key in USES else key if key == "merging" else f"`{key}:`"


def _may(language: TargetLanguage, key: str) -> str:
    if key == "standard" and language.standards:
        return ", ".join(map(str, language.standards))
    return "yes" if key in language.has else "no effect" if key in language.ignored else "-"


def _build(language: TargetLanguage) -> str:
    return " && ".join(f"`{' '.join(words).format(folder='.')}`" for words in language.build) or "nothing"


def test_the_page_is_the_table(request: pytest.FixtureRequest) -> None:
    text = PAGE.read_text(encoding="utf-8")
    before, _, rest = text.partition("<!-- table -->\n")
    _, _, after = rest.partition("<!-- end -->\n")
    whole = f"{before}<!-- table -->\n{rows()}<!-- end -->\n{after}"
    if request.config.getoption("--update-golden"):
        PAGE.write_text(whole, encoding="utf-8")
    assert PAGE.read_text(encoding="utf-8") == whole
