"""Values written as properties, read by the real `Ice.Properties`, come back typed and equal."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import accessors
from parameters import Data, as_dict, linked, values
from random_parameters import HARD_TEXTS, TEXTS, documents
from robocomp_yaml.link.program import LinkedParameters
from robocomp_yaml.parameters.layers.effective import effective
from robocomp_yaml.parameters.writing.properties import properties, property_text
from verdicts import CASES

Ice = pytest.importorskip("Ice", reason="needs Ice's Python module (Debian: python3-zeroc-ice)")
RELAXED = settings(
    max_examples=CASES,
    deadline=None,
    suppress_health_check=list(HealthCheck),
    phases=[Phase.explicit, Phase.reuse, Phase.generate],  # a case is small as it is; shrinking one takes minutes
)


@pytest.fixture(scope="module")
def by_ice(tmp_path_factory: pytest.TempPathFactory):
    path = tmp_path_factory.mktemp("ice") / "config"

    def read(text: str) -> dict[str, str]:
        path.write_bytes(text.encode())
        held = Ice.createProperties()
        held.load(str(path))
        return dict(held.getPropertiesForPrefix(""))

    return read


def comes_back(by_ice, of: LinkedParameters, data: Data, **more: Any) -> list[str]:
    """What no property can hold; where there is nothing of that, the rest must come back equal."""
    document = values(of, data, **more)
    found, faults = effective(document)
    assert found is not None, faults
    sections, faults = properties(document, found)
    if not faults:
        held = by_ice(property_text(sections, "TestComp", "config.yaml"))
        assert held == as_dict(sections)
        quoted = more.get("legacy", {}).get("dialect") == "flat-toml"
        marked = {**held, "Endpoints.CommonBehavior": '"tcp"'} if quoted else held  # as every such file is
        assert accessors.read_back(of.parameters, marked) == found.data
    return [fault.message for fault in faults]


@given(documents())
@RELAXED
def test_values_come_back(by_ice, case: tuple[Data, Data]) -> None:
    document, data = case
    comes_back(by_ice, linked(document), data)


@given(documents())
@RELAXED
def test_values_come_back_from_a_legacy_file(by_ice, case: tuple[Data, Data]) -> None:
    """Only what was set is there, in quotes; the defaults are the reader's."""
    document, data = case
    comes_back(by_ice, linked(document), data, legacy={"file": "config", "dialect": "flat-toml"})


MOTOR = {
    "types": {
        "Kind": {"enum": ["slow", "fast"]},
        "Motor": {
            "struct": {
                "name": "string",
                "kind": {"type": "Kind", "default": "slow"},
                "min": "float",
                "tag": {"type": "string", "optional": True},
                "note": {"type": "string", "default": "none"},
                "on": {"type": "bool", "default": True},
            }
        },
    },
    "parameters": {
        "motors": {"list": "Motor"},
        "cams": {"list": "Motor", "default": []},
        "one": "Motor",
        "groups": {"list": {"list": "string"}},
        "table": {"list": "Motor"},
        "ids": {"list": "string", "default": []},
        "byKey": {"list": "Motor", "default": []},
        "device": "string",
    },
    "legacy": {
        "motors": {
            "key": "Bus.M{i}",
            "first": 1,
            "columns": ["name", "kind", "min", "tag", "note", "on"],
            "count": "Bus.Count",
        },
        "cams": {"fields": {"name": "name_{i}", "min": "min_{i}", "tag": "tag_{i}"}, "count": "num_cams"},
        "one": {"key": "One", "columns": ["name", "min"], "separator": ";"},
        "groups": {"key": "Excluded", "separators": [";", ","], "trailing": True},
        "table": {"key": "Table", "separators": [";", ","], "columns": ["name", "min", "tag"]},
        "ids": {"key": "Id{i}"},
        "byKey": {"key": "ID:{name}-{kind}", "columns": ["min"]},
        "device": "Bus.Device",
    },
}
WORDS = st.sampled_from(("a", "b c", "x#", "=", "\\", '"q"')) | TEXTS | HARD_TEXTS
MOTORS = st.fixed_dictionaries(
    {"name": WORDS, "min": st.floats(-5, 5) | st.integers(-5, 5)},
    optional={"kind": st.sampled_from(("slow", "fast")), "tag": WORDS, "note": WORDS, "on": st.booleans()},
)
PARAMETERS = {
    "motors": st.lists(MOTORS, max_size=3),
    "cams": st.lists(MOTORS, max_size=2),
    "one": MOTORS,
    "groups": st.lists(st.lists(WORDS, max_size=2), max_size=3),
    "table": st.lists(MOTORS, max_size=2),
    "ids": st.lists(WORDS, max_size=3),
    "byKey": st.lists(MOTORS, max_size=1),
    "device": WORDS,
}


SIMPLE: Data = {"motors": [], "one": {"name": "x", "min": 1}, "groups": [], "table": [], "device": "d"}
# One at a time: a fault of one hides nothing of another.
SPELLED = st.one_of(
    *(value.map(lambda value, name=name: {**SIMPLE, name: value}) for name, value in PARAMETERS.items())
)


@given(SPELLED)
@settings(RELAXED, max_examples=max(CASES // 2, 1))
def test_spelled_values_come_back_or_are_rejected(by_ice, data: Data) -> None:
    comes_back(by_ice, linked(MOTOR), data)


@given(SPELLED)
@settings(RELAXED, max_examples=max(CASES // 5, 1))
def test_spelled_values_of_files_that_seem_to_be_toml(by_ice, data: Data) -> None:
    comes_back(by_ice, linked({**MOTOR, "legacy": {**MOTOR["legacy"], "period.compute": "Period.Compute"}}), data)


def test_a_plain_case_of_each_spelling_is_not_rejected(by_ice) -> None:
    motor = {"name": "a", "kind": "fast", "min": 0.5, "tag": "t", "note": "n", "on": False}
    plain = {"name": "a", "min": 0.5}
    data = {
        "motors": [motor, {**motor, "name": "b c"}, {**plain, "note": ""}],
        "cams": [{**plain, "tag": "t"}, plain],
        "one": plain,
        "groups": [["a", "b"], ["c"]],
        "table": [plain, {**plain, "tag": "t"}],
        "ids": ["x", "y"],
        "byKey": [{"name": "n", "min": 1, "kind": "fast"}],
        "device": "/dev/x",
    }
    assert comes_back(by_ice, linked(MOTOR), data) == []


def test_very_long_lists(by_ice) -> None:
    of = linked({"parameters": {"names": {"list": "string"}, "rows": {"list": {"list": "int", "size": 2}}}})
    data = {"names": [f"n{i} #" for i in range(3000)], "rows": [[i, -i] for i in range(3000)]}
    assert comes_back(by_ice, of, data) == []
