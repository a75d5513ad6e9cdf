"""The entries for SchemaStore's catalogue: what its own checks demand, and that each names a schema of ours."""

from __future__ import annotations

import json

import jsonschema
import pytest

from conftest import ROOT
from robocomp_yaml.link.workspace_files import GLOBS
from robocomp_yaml.source.schema_text import schema_text

FOLDER = ROOT / "editors/schemastore"
ENTRIES = json.loads((FOLDER / "catalog.json").read_text())["schemas"]
HOME = "https://raw.githubusercontent.com/robocomp/rcyaml/main/"


def kind_of(entry: dict[str, object]) -> str:
    return str(entry["url"]).rpartition("/")[2].removesuffix(".schema.json")


def test_every_kind_with_a_name_of_its_own_is_there() -> None:
    """`etc/config.yaml` may be a file of any program; a values document names the schema of its component."""
    assert {kind_of(entry) for entry in ENTRIES} == set(GLOBS) - {"config"}


@pytest.mark.parametrize("entry", ENTRIES, ids=kind_of)
def test_an_entry_is_as_the_catalogue_demands(entry: dict[str, str]) -> None:
    assert set(entry) == {"name", "description", "fileMatch", "url"}
    assert "schema" not in (entry["name"] + entry["description"]).lower()  # as its checks forbid
    assert set(entry["fileMatch"]) <= set(GLOBS[kind_of(entry)])
    schema = json.loads((ROOT / entry["url"].removeprefix(HOME)).read_text())
    jsonschema.Draft7Validator.check_schema(schema)


def test_the_schema_of_components_has_the_languages(request: pytest.FixtureRequest) -> None:
    """In `schemas/` it has placeholders for them; --update-golden writes it."""
    if request.config.getoption("--update-golden"):
        (FOLDER / "cdsl.schema.json").write_text(schema_text("cdsl"))
    assert (FOLDER / "cdsl.schema.json").read_text() == schema_text("cdsl")
