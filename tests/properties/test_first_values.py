"""A first values document fits its parameters, and stays one that can be completed by hand, whatever `config set` did:
taking the # away from its lines gives a document that checks."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from constraints import CONSTRAINTS, subject
from robocomp_yaml.cli import group
from verdicts import CASES

RELAXED = settings(max_examples=max(CASES // 10, 5), deadline=None, suppress_health_check=list(HealthCheck))
# "  # speed: 0.5", but no comment in words
ENTRY = re.compile(r"^( {2,})# (\"[^\"]+\"|[A-Za-z0-9_-]+):( .*)?$")
DOCUMENTS = {
    "ranges": "parameters: {min: float, max: float, mid: {type: float, optional: true}}\n"
              "constraints: [min < max, 'min <= mid <= max']\n",
    "a chain": "parameters: {a: int, b: int, c: {type: int, range: [2, 9]}, d: {type: int, default: 5}}\n"
               "constraints: [a > b, b > c, d > a - 20]\n",
    "below a default": "parameters: {limit: {type: int, default: -3}, low: int, far: {type: int, optional: true}}\n"
                       "constraints: [low < limit, far < low]\n",
    "a sum": "parameters: {weights: {list: float, size: 3}, more: {list: float, size: 2, optional: true}}\n"
             "constraints: [sum(weights) == 1, max(more) > 100]\n",
    "records": "types: {M: {struct: {name: string, min: float, max: float, at: {type: float, default: 1}}}}\n"
               "parameters: {motors: {list: M, size: [3, 8]}}\nconstraints: [unique(m.name for m in motors), "
               "all(m.min < m.at < m.max for m in motors), sum(m.max for m in motors) < 10]\n",
    "an optional one that is needed": "parameters: {on: bool, off: bool, port: {type: int, optional: true}}\n"
                                      "constraints: [on and off or has(port), on != off, port > 1024]\n",
    "either of two": "parameters: {a: {type: int, optional: true}, b: {type: int, optional: true}}\n"
                     "constraints: [not (has(a) and has(b))]\n",
    "different ones": "parameters: {ids: {list: {type: int, range: [3, 7]}, size: 5, unique: true}, names: {list: "
                      "{type: string, pattern: 'cam[0-9]'}, size: 4, unique: true}}\n",
    "many": "parameters: {gains: {list: float, size: 40}, table: {map: int, size: 20}}\n",
    "as long as another": "parameters: {a: {list: int, size: [2, 5]}, b: {list: string}}\n"
                          "constraints: [len(a) == len(b)]\n",
    "groups": "parameters:\n  Net: {group: {low: int, high: int, Deep: {group: {high: {type: int, optional: true}}}}}\n"
              "  high: {type: int, default: 3}\n  Last: {group: {name: {type: string, default: x}}}\n"
              "constraints: [Net.low < Net.high, Net.Deep.high > Net.high + 100, high < Net.low]\n",
    "texts": "parameters: {mode: {type: string}, speed: {type: float, default: 0}}\n"
             "constraints: [\"mode in ['slow', 'fast']\"]\n",
    "other names": "parameters: {2d: {type: int, as: view}, on: {type: int, default: 0, as: is_on}}\n"
                   "constraints: [view > is_on]\n",
    "docs": "parameters:\n  device: {type: string, default: x, doc: \"Where.\\n\\ndevice: x\\n\"}\n"
            "  d: {type: int, default: 1}\n",
    "all constraints of the accessors' tests": subject(*CONSTRAINTS[:3], CONSTRAINTS[5], CONSTRAINTS[8]),
}  # fmt: skip
DOCUMENTS |= {that: subject(that) for that in CONSTRAINTS if that != "has(limit) and limit > low"}  # breaks by itself


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    path, before = tmp_path_factory.mktemp("first"), Path.cwd()
    os.chdir(path)
    yield path
    os.chdir(before)


def run(*args: str) -> Result:
    result = CliRunner().invoke(group, ["config", *args], prog_name="rcyaml")
    if result.exception and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result


def errors(folder: Path, text: str) -> list[str]:
    (folder / "etc/config.yaml").write_text(text)
    told = json.loads(run("check", "etc/config.yaml", "--format", "json").output)["diagnostics"]
    return [each["message"] for each in told if each["severity"] == "error"]


def new(folder: Path, document: str) -> str:
    (folder / "c.cdsl.yaml").write_text("component: C\nlanguage: python\n")
    (folder / "c.pdsl.yaml").write_text(f"component: c.cdsl.yaml\n{document}")
    (folder / "etc/config.yaml").unlink(missing_ok=True)
    made = run("new", "c.cdsl.yaml")
    assert made.exit_code == 0, made.output
    return (folder / "etc/config.yaml").read_text()


def entries(text: str) -> list[int]:
    """The lines from which the # can be taken away. Doc texts have the same look, but stand above their own entry."""
    lines = text.splitlines()
    found: dict[tuple[str, str, int], int] = {}
    block = 0
    for n, line in enumerate(lines):
        block += bool(line.strip()) and not line.lstrip().startswith("#")
        if match := ENTRY.match(line):
            found[match[1], match[2], block] = n
    return sorted(found.values())


def uncommented(text: str, chosen: list[int]) -> str:
    lines = text.splitlines(keepends=True)
    for n in chosen:
        lines[n] = lines[n].replace("# ", "", 1)
    return "".join(lines)


@pytest.mark.parametrize("document", DOCUMENTS.values(), ids=DOCUMENTS)
def test_every_example_fits(folder: Path, document: str) -> None:
    text = new(folder, document)
    assert errors(folder, text) == [], text
    lines = entries(text)
    for chosen in ([n] for n in lines):
        assert errors(folder, uncommented(text, chosen)) == [], (text, chosen)
    assert errors(folder, uncommented(text, lines)) == [], text


@pytest.mark.parametrize("document", [
    "parameters: {a: {type: int, range: [0, 3]}, b: string, c: {type: int, optional: true}}\n"
    "constraints: [a > 5, c > a + 9]\n",
    "parameters: {a: {type: string, optional: true}}\nconstraints: [a == a and a != a]\n",
])  # fmt: skip
def test_where_no_example_is_found_the_document_says_so(folder: Path, document: str) -> None:
    text = new(folder, document)
    assert "no example satisfies the constraints" in text
    assert "\n  # a:\n" in text
    for told in errors(folder, text):
        assert re.search(r"\ba has no value|must hold", told), told


@given(st.sampled_from(sorted(DOCUMENTS)), st.data())
@RELAXED
def test_the_lines_can_be_used_after_any_sets(folder: Path, name: str, data: st.DataObject) -> None:
    text = new(folder, DOCUMENTS[name])
    for _ in range(data.draw(st.integers(1, 4))):
        shown = json.loads(run("show", "etc/config.yaml", "--format", "json").output)["values"]
        commented = [text.splitlines()[n] for n in entries(text)]
        rows = [(row["path"], row["value"]) for row in shown]
        path, value = data.draw(st.sampled_from(rows))
        spelled = value if isinstance(value, str) else json.dumps(value)
        assert run("set", "etc/config.yaml", path, spelled).exit_code == 0, (path, spelled, commented)
        text = (folder / "etc/config.yaml").read_text()
        lines = entries(text)
        chosen = data.draw(st.lists(st.sampled_from(lines), unique=True)) if lines else []
        assert errors(folder, uncommented(text, chosen)) == [], (text, chosen)
        assert errors(folder, uncommented(text, lines)) == [], text
        assert errors(folder, text) == []
