"""What the commands share that talk to components: values as JSON, and repetitions in time."""

from __future__ import annotations

import json
import time

import pytest

from robocomp_yaml.api.topics import Rate
from robocomp_yaml.commands import mock
from robocomp_yaml.commands._talking import as_json, as_text, times
from robocomp_yaml.commands.record import _Size

stand_ins = pytest.importorskip("robocomp_yaml.wire.stand_ins", reason="Ice for Python is not installed")


def test_json_has_no_infinite_numbers() -> None:
    text = as_json({"a": [float("nan"), 1.5], "b": {"c": float("-inf")}, "d": float("inf")})
    strict = json.loads(text, parse_constant=lambda name: pytest.fail(name))
    assert strict == {"a": ["NaN", 1.5], "b": {"c": "-Infinity"}, "d": "Infinity"}


def test_yaml_has_them() -> None:
    assert as_text({"a": float("nan"), "b": float("-inf")}, "yaml") == "a: .nan\nb: -.inf\n"


def test_times_do_not_drift() -> None:
    """What takes longer than the period skips times, and does not shift the later ones."""
    at = []
    began = time.monotonic()
    for number in times(4, 0.02):
        at.append(time.monotonic() - began)
        if number == 1:
            time.sleep(0.05)
    assert len(at) == 4
    assert at[0] < 0.02 <= at[1] and at[2] >= 0.06
    assert list(times(3, None)) == [0, 1, 2]


@pytest.mark.parametrize(
    ("value", "end"),
    [
        ([0] * 5000, "… (5000 values)) returns 7"),
        ([[0] * 5000], "…) returns 7"),
        ({"a": "b" * 5000}, "bbb…) returns 7"),
        ("b" * 5000, "bbb… (5000 characters)) returns 7"),
        ([1, {"a": "b"}], "([1, {a: b}]) returns 7"),
    ],
)
def test_only_the_beginning_of_a_long_value_is_shown(value: object, end: str) -> None:
    call = stand_ins.Call("Arm", "store", {"image": value}, {"returns": 7})
    shown = mock._line(call)
    assert shown.replace("image: ", "").endswith(end) and len(shown) < 300


def test_rate_and_jitter() -> None:
    rate = Rate()
    assert rate.report()["mean"] is None
    rate.add([0.0, 0.010, 0.020, 0.040])
    assert rate.report() == {"messages": 4, "rate": 75.0, "mean": 13.333, "min": 10.0, "max": 20.0, "jitter": 4.714}
    rate.add([0.050])
    assert rate.report()["rate"] == 100.0  # since the last message of the report before
    assert rate.report()["rate"] == 0.0


@pytest.mark.parametrize(("text", "size"), [("500", 500), ("10KB", 10_000), ("1.5 MB", 1_500_000), ("2G", 2 * 10**9)])
def test_sizes(text: str, size: int) -> None:
    assert _Size().convert(text, None, None) == size
