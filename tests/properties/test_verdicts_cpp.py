"""Generated C++ accessors judge as all the others: one program with many generated parameters, and many values."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import accessors
from conftest import ROOT
from constraints import CASES, CONSTRAINTS, subject
from parameters import Data, documents, linked, mutated, parameters, values

from robocomp_yaml.emit.targets import cpp_parameters
from robocomp_yaml.model.parameters import Parameters, RecordType
from robocomp_yaml.values import evaluate
from robocomp_yaml.values.effective import effective
from robocomp_yaml.values.properties import as_dict, properties

pytestmark = [
    pytest.mark.slow, pytest.mark.skipif(shutil.which("g++") is None, reason="there is no g++ here"),
]  # fmt: skip
DRIVER = Path(__file__).parent.parent / "cpp_driver"
RUNTIME = ("texts", "kinds", "reading", "editing", "store", "expressions", "pattern")
TYPES = {"Mode": {"enum": ["slow", "fast", "off"]}}
DOCUMENTS = 40


@st.composite
def cases(draw: st.DrawFn) -> tuple[Data, Data, list[Any]]:
    """A document, values that fit it, and values that may not."""
    document, data = draw(documents())
    return document, data, [draw(mutated(data)) for _ in range(8)]


def drawn() -> list[tuple[Data, Data, list[Any]]]:
    """The same ones each time: the program is made of them."""
    found: list[tuple[Data, Data, list[Any]]] = []

    @given(cases())
    @settings(max_examples=DOCUMENTS, derandomize=True, deadline=None, database=None, phases=[Phase.generate],
              suppress_health_check=list(HealthCheck))  # fmt: skip
    def collect(case: tuple[Data, Data, list[Any]]) -> None:
        found.append(case)

    collect()
    return found


class Program:
    """The driver with the accessors of a document whose groups g0, g1 … are the documents of the cases."""

    def __init__(self, folder: Path) -> None:
        self.cases = drawn()
        types = self.cases[0][0]["types"]
        groups = {f"g{n}": {"group": document["parameters"]} for n, (document, _, _) in enumerate(self.cases)}
        self.subject = parameters(subject(*CONSTRAINTS))[0]
        self.parameters = linked({"types": types, "parameters": groups}).parameters
        both = RecordType("", tuple({m.name: m for p in (self.parameters, self.subject) for m in p.root.members}.values()))
        whole = Parameters(both, constraints=self.subject.constraints)
        for name, text in cpp_parameters.texts(whole, "Driver", "x.pdsl.yaml").items():
            (folder / name).write_text(text, encoding="utf-8")
        runtime = ROOT / "templates" / "cpp" / "runtime"
        (folder / "runtime").symlink_to(runtime)
        includes = [f'#include "runtime/{name}.cpp"' for name in RUNTIME] + ['#include "parameters.cpp"']
        (folder / "all.cpp").write_text("\n".join([*includes, f'#include "{DRIVER / "main.cpp"}"']) + "\n")
        command = ["g++", "-std=c++17", "-Wall", "-Wextra", "-Werror", f"-I{folder}", "-o", str(folder / "driver")]
        done = subprocess.run([*command, str(folder / "all.cpp")], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        self.path = folder / "driver"

    def ask(self, lines: list[str]) -> Iterator[list[str]]:
        """The words of each answer; the program sees no environment."""
        done = subprocess.run([self.path], input="\n".join(lines) + "\n", capture_output=True, text=True, env={})
        assert done.returncode == 0, done.stderr
        answers = done.stdout.splitlines()
        assert len(answers) == len(lines)
        return (answer.split() for answer in answers)

    def group(self, number: int) -> Parameters:
        return Parameters(RecordType("", (self.parameters.root.members[number],)))


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Program:
    return Program(tmp_path_factory.mktemp("driver"))


def encoded(data: Any) -> str:
    """JSON without blanks, its texts in hexadecimal."""

    def hexed(data: Any) -> Any:
        if isinstance(data, dict):
            return {hexed(key): hexed(value) for key, value in data.items()}
        if isinstance(data, list):
            return [hexed(item) for item in data]
        return data.encode().hex() if isinstance(data, str) else data

    return json.dumps(hexed(data), separators=(",", ":"))


def plain(words: list[str]) -> list[str]:
    """Messages out of hexadecimal, without those about the environment."""
    messages = [bytes.fromhex(word).decode() for word in words[1:]] if words[0] == "no" else []
    return [message for message in messages if "comes from the environment" not in message]


def test_the_same_verdict_and_the_same_words(program: Program) -> None:
    asked = [(n, data) for n, (_, fitting, others) in enumerate(program.cases) for data in (fitting, *others)]
    answers = program.ask([f"judge g{n} {encoded(data)}" for n, data in asked])
    refused = 0
    for (number, data), words in zip(asked, answers, strict=True):
        _, problems = accessors.take(program.group(number), {f"g{number}": data})
        got = plain(words)
        assert bool(got) == bool(problems), (program.cases[number][0], data, got, problems)
        refused += bool(got)
    assert len(asked) / 5 < refused < len(asked), "both happen often"


def test_properties_are_read_alike(program: Program) -> None:
    """What is written of values that fit is read by both, to the same values."""
    asked, expected = [], []
    for number, (_, data, _) in enumerate(program.cases):
        of = linked({"types": program.cases[0][0]["types"], "parameters": {
            f"g{number}": {"group": program.cases[number][0]["parameters"]}}})  # fmt: skip
        document = values(of, {f"g{number}": data})
        found, _ = effective(document)
        assert found is not None
        sections, faults = properties(document, found)
        if faults:
            continue
        held = as_dict(sections)
        asked.append(f"read g{number} {encoded(held)}")
        started = accessors.store(of.parameters, held)
        expected.append({key: entry.text for key, entry in started.entries().items() if key.startswith("g")})
    assert len(asked) > DOCUMENTS / 4
    for words, wanted in zip(program.ask(asked), expected, strict=True):
        assert words[0] == "fits", plain(words)
        pairs = (word.partition("=") for word in words[1:])
        got = {bytes.fromhex(key).decode(): bytes.fromhex(text).decode() for key, _, text in pairs}
        assert {key: _alike(key, text) for key, text in got.items()} == {
            key: _alike(key, text) for key, text in wanted.items()
        }


def _alike(key: str, text: str) -> object:
    """Maps have no order, and large and small numbers are spelled in two ways."""
    if key.endswith(".keys"):
        return sorted(text.split())
    try:
        return float(text) if "e" in text else text
    except ValueError:
        return text


def test_constraints_mean_what_the_checker_says(program: Program) -> None:
    for data, (bits,) in zip(CASES, program.ask([f"constraints {encoded(data)}" for data in CASES]), strict=True):
        expected = [evaluate.holds(each.expression, data) for each in program.subject.constraints]
        assert [bit == "1" for bit in bits] == expected, data
