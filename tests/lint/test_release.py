"""What a release is made of says the same everywhere: the version, the changelog, where the project lives."""

from __future__ import annotations

import re
import tomllib
from datetime import date

import robocomp_yaml
from conftest import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
HEAD = re.compile(r"## (?P<version>\d+\.\d+\.\d+) \((?P<date>unreleased|\d{4}-\d{2}-\d{2})\)")


def numbers(version: str) -> tuple[int, ...]:
    return tuple(map(int, version.split(".")))


def test_the_changelog_begins_with_this_version_and_earlier_ones_are_dated() -> None:
    lines = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8").splitlines()
    heads = [HEAD.fullmatch(line) for line in lines if line.startswith("## ")]
    sections = [(head["version"], head["date"]) for head in heads if head]
    assert len(sections) == len(heads) > 0, "a section is called '## 1.2.3 (2026-05-01)', or '(unreleased)'"
    assert sections[0][0] == robocomp_yaml.__version__
    assert [numbers(version) for version, _ in sections] == sorted({numbers(v) for v, _ in sections}, reverse=True)
    dates = [date.fromisoformat(when) for at, (_, when) in enumerate(sections) if at or when != "unreleased"]
    assert dates == sorted(dates, reverse=True)


def test_each_section_says_something() -> None:
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    for section in text.split("\n## ")[1:]:
        assert "\n- " in section, section.splitlines()[0]


def test_links_lead_to_where_the_project_lives() -> None:
    """Which is said once for people, and once for the pictures and links of the README."""
    pictures, links = PROJECT["tool"]["hatch"]["metadata"]["hooks"]["fancy-pypi-readme"]["substitutions"]
    home = PROJECT["project"]["urls"]["Homepage"]
    raw = home.replace("https://github.com/", "https://raw.githubusercontent.com/")
    assert f"]({raw}/v$HFPR_VERSION/" in pictures["replacement"].replace("\\1(", "](")
    assert links["replacement"].startswith(f"]({home}/blob/v$HFPR_VERSION/")
    assert all(url.startswith(home) for url in PROJECT["project"]["urls"].values())


def test_files_that_the_readme_leads_to_are_there() -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    links = re.findall(r"\]\((?![a-z]+:|#)([^)#\s]+)", text)
    assert links
    assert [link for link in links if not (ROOT / link).exists()] == []
