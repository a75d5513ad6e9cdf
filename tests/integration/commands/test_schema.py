"""`rcyaml schema`."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree
from robocomp_yaml.source.schema_text import schema_text

Run = Callable[..., Result]


@pytest.mark.parametrize("kind", ["idsl", "cdsl", "pdsl", "ddsl", "config", "workspace", "mock"])
def test_a_kind_is_printed(rcyaml: Run, kind: str) -> None:
    result = rcyaml("schema", kind)
    assert result.exit_code == 0
    assert json.loads(result.stdout) == json.loads(schema_text(kind))


def test_the_kinds_are_listed(rcyaml: Run) -> None:
    assert rcyaml("schema").stdout.startswith("idsl       *.idsl.yaml, idsl.yaml\n")
    rcyaml("init")
    rows = rcyaml("schema").stdout.splitlines()
    assert [row.split()[0] for row in rows] == ["idsl", "cdsl", "pdsl", "ddsl", "config", "workspace", "mock"]
    assert all(Path(row.split()[-1]).is_file() for row in rows)


def test_a_new_document_finds_its_schema(rcyaml: Run) -> None:
    rcyaml("init")
    assert rcyaml("schema", "interfaces/Hello.idsl.yaml").stdout == (
        "the schema of interfaces/Hello.idsl.yaml is 'idsl'\n"
        "editors find it by the first lines of the document: ../.rcyaml/schemas/idsl.schema.json\n"
    )
    assert rcyaml("schema", "rcyaml.yaml").stdout == (
        "the schema of rcyaml.yaml is 'workspace'\n"
        "editors find it by the first lines of the document: .rcyaml/schemas/workspace.schema.json\n"
    )


def test_a_document_without_a_modeline_is_found_by_the_settings(rcyaml: Run, tmp_path: Path) -> None:
    rcyaml("init")
    write_tree(tmp_path, {"x/cdsl.yaml": "component: X\n"})
    assert (
        "by the settings of the workspace: .rcyaml/schemas/cdsl.schema.json" in rcyaml("schema", "x/cdsl.yaml").stdout
    )


def test_a_document_outside_any_workspace_has_no_schema(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"idsl.yaml": "module: X\n"})
    result = rcyaml("schema", "idsl.yaml").stdout
    assert "editors do not find it" in result
    assert result.endswith("# yaml-language-server: $schema=.rcyaml/schemas/idsl.schema.json\n")


@pytest.mark.parametrize(("content", "reason"), [(None, "is missing"), ("{}", "the file of the schema is outdated")])
def test_a_stale_schema_is_reported(rcyaml: Run, tmp_path: Path, content: str | None, reason: str) -> None:
    rcyaml("init")
    schema = tmp_path / ".rcyaml/schemas/idsl.schema.json"
    schema.unlink()
    if content is not None:
        schema.write_text(content)
    assert reason in rcyaml("schema", "interfaces/Hello.idsl.yaml").stdout


@pytest.mark.parametrize(
    ("argument", "reason"),
    [
        ("ids", "did you mean 'idsl'?"),
        ("robot", "the kinds are idsl, cdsl, pdsl, ddsl, config, workspace, mock"),
        ("a.idsl.yaml", "does not exist"),
    ],
)
def test_other_arguments_are_rejected(rcyaml: Run, argument: str, reason: str) -> None:
    result = rcyaml("schema", argument)
    assert result.exit_code == 2
    assert reason in result.stderr
