"""Rendering, its cache, and the rule that templates have no logic."""

from __future__ import annotations

import os
import shutil
import stat
from collections.abc import Iterator
from pathlib import Path

import msgspec
import pytest
from jinja2 import Environment, UndefinedError, nodes

from robocomp_yaml import languages, resources
from robocomp_yaml.emit import render
from robocomp_yaml.emit.jinja import environment

FOLDERS = (Path(resources.folder("templates")), *(Path(language.templates) for language in languages.table().values()))
TEMPLATES = sorted(path for folder in FOLDERS for path in folder.rglob("*.j2"))

# `{{ name.field }}`, for, if of a flag, include; and the list that a `for` goes over.
ALLOWED = (
    nodes.Template,
    nodes.Output,
    nodes.TemplateData,
    nodes.Name,
    nodes.Getattr,
    nodes.For,
    nodes.If,
    nodes.Not,
    nodes.Include,
    nodes.Const,
)


class View(msgspec.Struct, frozen=True):
    """The view of the templates in these tests."""

    name: str
    items: tuple[str, ...] = ()


@pytest.fixture
def templates(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """An empty folder of templates, and a cache that is not the user's."""
    folder = tmp_path / "templates"
    folder.mkdir()
    monkeypatch.setattr(resources, "folder", lambda name: tmp_path / name)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    environment.cache_clear()
    yield folder
    environment.cache_clear()


@pytest.mark.parametrize("path", TEMPLATES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_a_template_has_no_logic(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert text.count("\n") <= 80
    tree = Environment().parse(text)
    assert [node for node in tree.find_all(nodes.Node) if not isinstance(node, ALLOWED)] == []
    for branch in tree.find_all(nodes.If):
        flag = branch.test.node if isinstance(branch.test, nodes.Not) else branch.test
        assert isinstance(flag, (nodes.Name, nodes.Getattr)), f"line {branch.lineno}: the view knows, not the template"


def test_fields_are_variables(templates: Path) -> None:
    (templates / "list.j2").write_text("{{ name }}:\n{% for item in items %}\n  - {{ item }}\n{% endfor %}\n")
    assert render.render("list.j2", View("é", ("<a>", "b"))) == "é:\n  - <a>\n  - b\n"


def test_a_variable_that_the_view_lacks(templates: Path) -> None:
    (templates / "wrong.j2").write_text("{{ nme }}")
    with pytest.raises(UndefinedError, match="nme"):
        render.render("wrong.j2", View("x"))


def again(templates: Path) -> str:
    """The text that the next run renders."""
    environment.cache_clear()
    return render.render("a.j2", View("x"))


def test_the_cache_is_private_and_detects_edits(templates: Path, tmp_path: Path) -> None:
    (templates / "a.j2").write_text("one {{ name }}")
    assert again(templates) == "one x"
    cache = tmp_path / "cache" / "rcyaml" / "templates"
    assert stat.S_IMODE(cache.stat().st_mode) == 0o700
    (cached,) = cache.iterdir()
    cached.write_bytes(b"broken")
    assert again(templates) == "one x"
    assert cached.stat().st_size > 6, "written anew"
    (templates / "a.j2").write_text("two {{ name }}")
    assert again(templates) == "two x"


def test_a_cache_that_others_can_write_is_not_used(templates: Path, tmp_path: Path) -> None:
    cache = tmp_path / "cache" / "rcyaml" / "templates"
    cache.mkdir(parents=True)
    cache.chmod(0o777)
    (templates / "a.j2").write_text("{{ name }}")
    assert again(templates) == "x"
    assert list(cache.iterdir()) == []


def test_without_a_cache(templates: Path, tmp_path: Path) -> None:
    """A file is at the path of the folder; then the disk is full."""
    (tmp_path / "cache").write_text("")
    (templates / "a.j2").write_text("{{ name }}")
    assert again(templates) == "x"


def test_a_full_disk(templates: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, os.strerror(28))

    (templates / "a.j2").write_text("{{ name }}")
    monkeypatch.setattr(os, "replace", full)
    assert again(templates) == "x"
    shutil.rmtree(tmp_path / "cache")
    assert again(templates) == "x"
