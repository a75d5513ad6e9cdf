"""`rcyaml config` on random parameters, values, layouts, paths and edits: it never fails in an unforeseen way, `set`
keeps every other byte, and what `export` prints is read back to the same values."""

from __future__ import annotations

import json
import os
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Any

import pytest
from click.testing import CliRunner, Result
from hypothesis import HealthCheck, Phase, event, given, settings
from hypothesis import strategies as st

import accessors
from layouts import laid_out
from parameters import Data, linked
from random_parameters import HARD_TEXTS, JUNK, NAMES, documents, mutated
from robocomp_yaml.cli import group
from robocomp_yaml.link.program import LinkedParameters
from robocomp_yaml.parameters.types import ListType, MapType, RecordType, Type
from robocomp_yaml.semantics import paths
from robocomp_yaml.source.properties import read
from robocomp_yaml.source.tree import parse
from robocomp_yaml.source.yaml_text import flow
from verdicts import CASES

RELAXED = settings(
    max_examples=max(CASES // 5, 1), deadline=None, suppress_health_check=list(HealthCheck),
    phases=[Phase.explicit, Phase.reuse, Phase.generate],
)  # fmt: skip
Case = tuple[Data, bytes, bytes | None]  # parameters, a values document, and the layer below it


@dataclass
class Folder:
    """A component with parameters and values, and what `rcyaml config` does with them."""

    path: Path

    def run(self, *args: str) -> Result:
        result = CliRunner().invoke(group, ["config", *args], prog_name="rcyaml")
        if result.exception and not isinstance(result.exception, SystemExit):
            raise result.exception
        assert result.exit_code in (0, 1, 2), result.output
        return result

    def write(self, document: Data, content: bytes, base: bytes | None) -> None:
        for path in self.path.rglob("*.yaml"):
            path.unlink()
        (self.path / "c.cdsl.yaml").write_text("component: C\nlanguage: python\n")
        (self.path / "c.pdsl.yaml").write_text(
            f"component: c.cdsl.yaml\n{flow(document)[1:-1]}".replace(", parameters: ", "\nparameters: ", 1)
        )
        (self.path / "x.config.yaml").write_bytes(content)
        if base is not None:
            (self.path / "base.config.yaml").write_bytes(base)

    @property
    def content(self) -> bytes:
        return (self.path / "x.config.yaml").read_bytes()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Folder]:
    path, before = tmp_path_factory.mktemp("config"), Path.cwd()
    os.chdir(path)
    yield Folder(path)
    os.chdir(before)


@st.composite
def cases(draw: st.DrawFn) -> Case:
    """A document of parameters, one of values, and sometimes a layer below it."""
    document, data = draw(documents())
    random = Random(draw(st.integers(0, 2**32)))
    base = None
    if draw(st.booleans()):
        below = {key: value for key, value in data.items() if draw(st.booleans())}
        base = laid_out({"component": "c.cdsl.yaml", "parameters": below}, random)
    for _ in range(draw(st.sampled_from((0, 0, 1)))):
        data = draw(mutated(data))
    head = {"component": "c.cdsl.yaml"} if base is None else {"extends": ["base.config.yaml"]}
    return document, laid_out({**head, "parameters": data}, random), base


@given(cases())
@RELAXED
def test_what_is_shown_is_got_and_exported(folder: Folder, case: Case) -> None:
    document, content, base = case
    of = linked(document)
    folder.write(document, content, base)
    checked = folder.run("check", "x.config.yaml")
    shown = folder.run("show", "x.config.yaml", "--format", "json", "--reveal")
    exported = folder.run("export", "x.config.yaml")
    as_toml = folder.run("export", "x.config.yaml", "--as", "toml")
    event(f"check ends with {checked.exit_code}")
    if checked.exit_code:
        assert {shown.exit_code, exported.exit_code, as_toml.exit_code} == {1}
        assert "error[" in checked.output
        return
    assert folder.run("show", "x.config.yaml").exit_code == shown.exit_code == exported.exit_code == 0
    rows = json.loads(shown.output)["values"]
    for row in rows:
        got = folder.run("get", "x.config.yaml", row["path"], "--reveal")
        assert got.exit_code == 0
        assert got.output == (row["value"] if isinstance(row["value"], str) else flow(row["value"])) + "\n"
    values, problems = accessors.as_written(of.parameters, read(exported.output).values)
    assert not problems
    assert _from(folder.path, values) == _of_rows(of, rows)
    loaded = tomllib.loads(as_toml.output)
    assert "env" in flow(values) or "file" in flow(values) or {key: loaded.get(key, {}) for key in values} == values


def _from(folder: Path, data: Any) -> Any:
    """Data whose references to files are from a folder, not absolute."""
    if isinstance(data, dict):
        if data.keys() == {"file"} and str(data["file"]).startswith(f"{folder}/"):
            return {"file": str(data["file"]).removeprefix(f"{folder}/")}
        return {key: _from(folder, value) for key, value in data.items()}
    return [_from(folder, item) for item in data] if isinstance(data, list) else data


def _of_rows(of: LinkedParameters, rows: list[dict[str, Any]]) -> Any:
    """The values that `show` lists one by one."""

    def put(type_: Type, data: Any, steps: list[str], value: Any) -> Any:
        if not steps:
            return value
        name, *rest = steps
        if isinstance(type_, ListType):
            place = int(name)
            items = [*(data or []), *([None] if place == len(data or []) else [])]
            items[place] = put(type_.element, items[place], rest, value)
            return items
        assert isinstance(type_, RecordType | MapType)
        member = type_.member(name) if isinstance(type_, RecordType) else None
        inner = member.type if member is not None else type_.element  # type: ignore[union-attr]
        return {**(data or {}), name: put(inner, (data or {}).get(name), rest, value)}

    made: Any = _groups(of.parameters.root)
    for row in rows:
        made = put(of.parameters.root, made, paths.parse(row["path"]) or [], row["value"])
    return made


def _groups(record: RecordType) -> dict[str, Any]:
    return {m.name: _groups(m.type) for m in record.members if m.is_group and isinstance(m.type, RecordType)}


PATHS = st.lists(st.sampled_from((*NAMES, "x", "name", "tag", "note", "on", "[0]", "[7]", '["a b"]', ".0", "period.compute",
                                  "[", '["', "%", "x-a", "")), max_size=3).map(".".join) | HARD_TEXTS  # fmt: skip
WORDS = (
    HARD_TEXTS
    | JUNK.map(flow)
    | st.sampled_from(
        (
            "1",
            "-7",
            "2.5",
            "fast",
            "A1",
            "true",
            "null",
            "{env: HOME}",
            "{file: a/b}",
            "{file: a/}",
            "[1, 2]",
            "{x: 1}",
            "{x: 1, tag: a}",
            "[{x: 1}]",
            "[[1]]",
            "a: b",
            "&a 1",
            "*a",
            "!!str 1",
            "|",
            "# c",
            "{",
            "- 1",
            "\n",
            "a\nb: 1",
            "é",
            "1 # c",
            "'",
            "{left: 1}",
            "---",
        )
    )
)


@given(cases(), st.data())
@RELAXED
def test_set_keeps_every_other_byte(folder: Folder, case: Case, more: st.DataObject) -> None:
    document, content, base = case
    folder.write(document, content, base)
    shown = folder.run("show", "x.config.yaml", "--format", "json", "--reveal")
    rows = json.loads(shown.output)["values"] if shown.exit_code == 0 else []
    texts = {row["path"]: row["value"] if isinstance(row["value"], str) else flow(row["value"]) for row in rows}
    for _ in range(4):
        path = more.draw(st.sampled_from(sorted(texts)) | PATHS if texts else PATHS)
        value = more.draw(st.just(texts[path]) | WORDS if path in texts else WORDS)
        before = folder.content
        result = folder.run("set", "x.config.yaml", path, value)
        after = folder.content
        event(f"set ends with {result.exit_code}")
        assert folder.run("get", "x.config.yaml", path).exit_code in (0, 1, 2)
        if result.exit_code:
            assert after == before
            continue
        was = result.output.partition(" (was ")[2].removesuffix(")\n")
        assert "***" in was or _gone(before, after).decode() in was, result.output
        old, new = (_data(text, paths.parse(path) or []) for text in (before, after))
        assert old == new, result.output


def _gone(before: bytes, after: bytes) -> bytes:
    """The stretch that is no longer there."""
    start = len(os.path.commonprefix([before, after]))
    end = len(os.path.commonprefix([before[start:][::-1], after[start:][::-1]]))
    return before[start : len(before) - end]


def _data(content: bytes, steps: list[str]) -> Any:
    """The values of a document, but for those at a path and what holds nothing else."""
    root, faults = parse("x.config.yaml", content.decode("utf-8-sig"))
    assert root is not None and not faults

    def without(data: Any, steps: list[str]) -> Any:
        if not steps:
            return None
        if isinstance(data, list):
            return [without(item, steps[1:]) if str(n) == steps[0] else item for n, item in enumerate(data)]
        if data is None:
            return None
        inner = without(data[steps[0]], steps[1:]) if steps[0] in data else None
        others = {key: value for key, value in data.items() if key != steps[0]}
        return ({**others, steps[0]: inner} if inner is not None else others) or None

    return without(root.data, ["parameters", *steps])


@given(documents())
@RELAXED
def test_a_first_document_lacks_nothing(folder: Folder, case: tuple[Data, Data]) -> None:
    """Its examples may be wrong for a pattern, or for a list whose entries all differ, and a default may be one that no
    property can hold: nothing else is wrong."""
    document, _ = case
    folder.write(document, b"", None)
    assert folder.run("new", "c.cdsl.yaml").exit_code == 0
    made = (folder.path / "etc" / "config.yaml").read_bytes()
    told = json.loads(folder.run("check", "etc/config.yaml", "--format", "json").output)["diagnostics"]
    assert {each["code"] for each in told if each["severity"] == "error"} <= {
        "RC3304",
        "RC3306",
        "RC3310",
    }, (document, made, told)
    assert folder.run("new", "c.cdsl.yaml").exit_code == 2
    assert (folder.path / "etc" / "config.yaml").read_bytes() == made
