"""Generated accessors of other languages than Python judge as all the others: one program a language, with many
generated parameters, and many values."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import accessors
import of_languages
import spellings
from conftest import FUZZING
from constraints import CASES, CONSTRAINTS, subject
from parameters import Data, as_dict, linked, parameters, values
from random_parameters import documents, mutated
from robocomp_yaml.parameters.expressions import evaluate
from robocomp_yaml.parameters.layers.effective import effective
from robocomp_yaml.parameters.types import Parameters, RecordType
from robocomp_yaml.parameters.writing.properties import properties
from verdicts import CPP_DOCUMENTS, verdicts

pytestmark = [pytest.mark.slow, pytest.mark.processes]  # by the compilers, and the programs that they make
LANGUAGES = [each for each in of_languages.each() if of_languages.spoken(each.values[0]).judge]


@st.composite
def cases(draw: st.DrawFn) -> tuple[Data, Data, list[Any]]:
    """A document, values that fit it, and values that may not."""
    document, data = draw(documents())
    return document, data, [draw(mutated(data)) for _ in range(8)]


def drawn() -> list[tuple[Data, Data, list[Any]]]:
    """The same ones each time: the program is made of them."""
    found: list[tuple[Data, Data, list[Any]]] = []

    @given(cases())
    @settings(max_examples=CPP_DOCUMENTS, derandomize=not FUZZING, deadline=None, database=None, phases=[Phase.generate],
              suppress_health_check=list(HealthCheck))  # fmt: skip
    def collect(case: tuple[Data, Data, list[Any]]) -> None:
        found.append(case)

    collect()
    return found


class Subjects:
    """The program, and what it is made of: the documents of the cases as groups g0, g1 …, and two documents by hand."""

    def __init__(self, language: str, folder: Path) -> None:
        self.cases = drawn()
        self.documents = [
            linked({"types": document["types"], "parameters": {f"g{n}": {"group": document["parameters"]}}})
            for n, (document, _, _) in enumerate(self.cases)
        ]
        self.spelled = linked(spellings.DOCUMENT).parameters
        self.constrained = parameters(subject(*CONSTRAINTS))[0]
        all_ = [self.spelled, self.constrained, *(of.parameters for of in self.documents)]
        whole = Parameters(
            RecordType("", tuple({member.name: member for each in all_ for member in each.root.members}.values())),
            constraints=self.constrained.constraints,
            spellings=self.spelled.spellings,
        )
        judge = of_languages.spoken(language).judge
        assert judge is not None
        self.program = judge(folder, whole)


@pytest.fixture(scope="module", params=LANGUAGES)
def subjects(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Subjects:
    return Subjects(request.param, tmp_path_factory.mktemp(request.param))


def test_the_same_verdict_about_the_same_parameters(subjects: Subjects) -> None:
    asked = [(n, data) for n, (_, fitting, others) in enumerate(subjects.cases) for data in (fitting, *others)]
    refused = 0
    answers = subjects.program.judge([(f"g{n}", data) for n, data in asked])
    for (number, data), problems in zip(asked, answers, strict=True):
        of, whole = subjects.documents[number].parameters, {f"g{number}": data}
        found = {**verdicts(of, whole), "generated accessors": not problems}
        assert len(set(found.values())) == 1, (subjects.cases[number][0], data, found, problems)
        assert _blamed(problems) == _blamed(accessors.take(of, whole)[1]), (whole, problems)
        refused += bool(problems)
    assert len(asked) / 5 < refused < len(asked), "both happen often"


def _blamed(problems: list[str]) -> list[str]:
    """The parameter that each message names; the languages spell values in their own ways."""
    return sorted(re.split(r" (?:must be|is|has|contains) ", problem)[0] for problem in problems)


def test_properties_are_read_alike(subjects: Subjects) -> None:
    """What is written of values that fit is read by both, to the same values."""
    asked, expected = [], []
    for number, (_, data, _) in enumerate(subjects.cases):
        of = subjects.documents[number]
        document = values(of, {f"g{number}": data})
        found, _ = effective(document)
        assert found is not None
        sections, faults = properties(document, found)
        if faults:
            continue
        held = as_dict(sections)
        asked.append((f"g{number}", held))
        expected.append(_as_python_reads(of.parameters, held))
    assert len(asked) > CPP_DOCUMENTS / 4
    for (got, problems), wanted in zip(subjects.program.read(asked), expected, strict=True):
        assert problems == []
        assert _comparable(got) == _comparable(wanted)


def test_spelled_properties_are_read_alike(subjects: Subjects) -> None:
    answers = subjects.program.read([("spelled", held) for held, _ in spellings.CASES])
    for (held, expected), (got, problems) in zip(spellings.CASES, answers, strict=True):
        assert bool(problems) == (expected is None), (held, problems)
        if expected is not None:
            assert _comparable(got) == _comparable(_as_python_reads(subjects.spelled, held)), held


_A: Data = {"name": "a", "id": 7}
NULLS: list[tuple[Data, Data | None]] = [
    # What a component sets of the group `spelled`, and what it then has; None where it is refused.
    ({"one": {"name": "a", "tag": None, "gain": None}}, {"one": _A}),
    ({"one": {"name": "a", "id": None}}, {"one": _A}),
    ({"one": None, "name": None, "id": 1}, {"id": 1}),
    ({"plain": [{"name": "a", "tag": None}, {"name": "b", "id": 2, "tag": "t"}]},
     {"plain": [_A, {"name": "b", "id": 2, "tag": "t"}]}),
    ({"sizes": {"x": {"name": "a", "gain": None}, "y": None}}, {"sizes": {"x": _A}}),
    ({"ids": None, "words": None}, {}),
    ({"one": {"name": None}}, None),
    ({"one": {"name": "a", "nam": None}}, None),
    ({"plain": [None]}, None),
    ({"ids": ["x", None]}, None),
]  # fmt: skip


def test_nothing_inside_a_value_that_is_set_is_the_default(subjects: Subjects) -> None:
    """As null in a values document."""
    answers = subjects.program.put([("spelled", data) for data, _ in NULLS])
    for (data, expected), (got, problems) in zip(NULLS, answers, strict=True):
        whole = {"spelled": data}
        read, texts, refused = accessors.put(subjects.spelled, whole)
        found = effective(values(linked(spellings.DOCUMENT), whole))[0]
        assert bool(problems) == bool(refused) == (found is None) == (expected is None), (data, problems, refused)
        if expected is not None:
            assert found is not None
            given = {key: value for key, value in read["spelled"].items() if value != [] and value != {}}
            assert given == expected and read["spelled"] == found.data["spelled"], data
            assert _comparable(got) == _comparable(_without_periods(texts)), data


PERIODS: list[tuple[dict[str, str], tuple[int, int] | None]] = [
    ({"Period.Compute": "20", "Period.Emergency": "30"}, (20, 30)),
    ({"Period.Compute": "20", "period.compute": "10"}, (10, 500)),
    ({"period.Compute": "20", "Period.compute": "20", "PERIOD.COMPUTE": "20"}, (100, 500)),
    ({"Period.Compute": "0"}, None),
]


def test_the_names_of_robocomp_for_periods_are_read_alike(subjects: Subjects) -> None:
    answers = subjects.program.read([("period", held) for held, _ in PERIODS])
    of = linked({"parameters": {}}).parameters
    for (held, expected), (got, problems) in zip(PERIODS, answers, strict=True):
        read, refused = accessors.as_written(of, held)
        assert bool(problems) == bool(refused) == (expected is None), (held, problems, refused)
        if expected is not None:
            assert read == {"period": dict(zip(("compute", "emergency"), expected, strict=True))}, held
            assert list(map(int, (got["period.compute"], got["period.emergency"]))) == list(expected), held


def _as_python_reads(of: Parameters, held: dict[str, str]) -> dict[str, str]:
    """Every plain value but the periods, which each component has."""
    entries = accessors.store(of, held).entries()
    return _without_periods({key: entry.text for key, entry in entries.items()})


def _without_periods(texts: dict[str, str]) -> dict[str, str]:
    return {key: text for key, text in texts.items() if not key.startswith("period.")}


def _comparable(texts: dict[str, str]) -> dict[str, object]:
    return {key: _alike(key, text) for key, text in texts.items()}


def _alike(key: str, text: str) -> object:
    """Maps have no order, and large and small numbers are spelled in two ways."""
    if key.endswith(".keys"):
        return sorted(text.split())
    try:
        return float(text) if "e" in text or "." in text else text
    except ValueError:
        return text


def test_constraints_mean_what_the_checker_says(subjects: Subjects) -> None:
    for data, got in zip(CASES, subjects.program.constraints(CASES), strict=True):
        expected = [evaluate.holds(each.expression, data) for each in subjects.constrained.constraints]
        assert got == expected, data
