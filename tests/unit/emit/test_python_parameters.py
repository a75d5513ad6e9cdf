"""Generated Python accessors: reading, setting, rejecting, notifying; and their source."""

from __future__ import annotations

import ast
import threading
from collections.abc import Callable, Mapping
from typing import Any

import pytest

import accessors
from constraints import CASES, CONSTRAINTS, subject
from parameters import parameters
from robocomp_yaml.languages.python import parameters as python_parameters
from robocomp_yaml.parameters.expressions import evaluate

ARM = """\
doc: What the arm needs.
types:
  Handler: {doc: Who drives it., enum: {Dunkermotoren: {doc: The old one.}, Faulhaber: }}
  Motor:
    doc: One motor of the bus.
    struct:
      name: string
      id: string
      invertedSign: {type: bool, default: false}
      min: {type: float, range: [-3.15, 3.15], unit: rad}
      max: {type: float, range: [-3.15, 3.15], unit: rad}
      vel: {type: float, range: [0, 2], default: 0.9, unit: rad/s}
parameters:
  handler: {type: Handler, default: Dunkermotoren, editable: true}
  device: {type: string, pattern: "/dev/[a-z]+", default: /dev/tty, doc: Where the bus is.}
  baudRate: {type: int, values: [9600, 115200], default: 115200, editable: true}
  basicPeriod: {type: int, range: [1, 1000], unit: ms, default: 220, editable: true}
  token: {type: string, optional: true, editable: true}
  threshold: {type: double, range: {from: 0, below: 1}, default: 0, editable: true}
  Yolo: {group: {use_gpu: {type: bool, default: true}, model: {type: string, default: m, editable: true}}}
  motors: {list: Motor, size: [1, 3], editable: true}
  gains: {list: {list: float, size: 3}, default: [[1, 0, 0]], editable: true}
  ids: {list: int, unique: true, default: [], editable: true}
  offsets: {map: float, default: {}, editable: true}
  low: {type: int, default: 1, editable: true}
  high: {type: int, default: 2, editable: true}
  2d: {type: bool, as: view2d, default: false}
  class: {type: string, default: x}
constraints:
  - {that: "all(m.min < m.max for m in motors)", else: a motor's min must be below its max}
  - low < high
legacy:
  device: Arm.Device
  motors: {key: "Arm.M{i}", columns: [name, id, invertedSign, min, max, vel], count: Arm.NumMotors}
"""
CONFIG = {"Arm.Device": "/dev/usb", "Arm.NumMotors": "2", "Arm.M0": "a, A, True, -3.14, 3.14, .9",
          "Arm.M1": "b,B,false,-1,1,1"}  # fmt: skip


@pytest.fixture
def arm() -> Any:
    return accessors.live(parameters(ARM)[0], CONFIG)


def refused(action: Callable[[], object]) -> list[str]:
    """The messages of the ParameterError that it raises."""
    accessors.python(parameters("parameters: {x: {type: int, default: 1}}\n")[0])
    from generated.runtime.semantics.problems import ParameterError  # type: ignore[import-not-found]

    with pytest.raises(ParameterError) as error:
        action()
    return [problem.message for problem in error.value.problems]


def started(text: str, properties: Mapping[str, str], overrides: Mapping[str, str] | None = None) -> Any:
    return accessors.live(parameters(text)[0], dict(properties), dict(overrides or {}))


def test_members_named_like_types() -> None:
    """In the body of a class, members hide types of the module."""
    text = """\
types:
  Point: {struct: {x: {type: int, default: 1}}}
  Mode: {enum: [a, b]}
parameters:
  Point: {type: Point, default: {}}
  Mode: {type: Mode, default: a}
  other: {type: Point, default: {x: 2}}
"""
    live = started(text, {"Point.x": "3"})
    assert (live.Point.x, live.Mode, live.other.x) == (3, "a", 2)


def test_golden(golden: Callable[[str, Mapping[str, str]], None]) -> None:
    text = python_parameters.text(parameters(ARM)[0], "ArmComp", "arm.pdsl.yaml")
    golden("python/parameters", {"parameters.py": text})


def test_reading(arm: Any) -> None:
    assert (arm.basicPeriod, arm.device, arm.handler, arm.token) == (220, "/dev/usb", "Dunkermotoren", None)
    assert (arm.motors[0].vel, arm.motors[0].invertedSign, arm.motors[1].min) == (0.9, True, -1.0)
    assert (arm.Yolo.use_gpu, arm.gains, dict(arm.offsets), arm.view2d, arm.class_) == (
        True, ((1.0, 0.0, 0.0),), {}, False, "x",
    )  # fmt: skip
    assert (arm.period.compute, arm.period.emergency) == (100, 500)


def test_setting(arm: Any) -> None:
    arm.set("basicPeriod", 100)
    arm.set("motors[1].vel", 2)
    arm.set('offsets["a.b"]', 1)
    arm.threshold = 0.5
    arm.change({"low": 5, "high": 6, "Yolo.model": "n", "token": "t"})
    assert (arm.basicPeriod, arm.motors[1].vel, arm.offsets["a.b"], arm.threshold) == (100, 2.0, 1.0, 0.5)
    assert (arm.low, arm.high, arm.Yolo.model, arm.token) == (5, 6, "n", "t")
    arm.set("motors", [*arm.motors, {"name": "c", "id": "C", "min": 0, "max": 1}])
    assert arm.motors[2].vel == 0.9
    arm.set("token", None)
    arm.set("basicPeriod", None)
    assert (arm.token, arm.basicPeriod) == (None, 220), "None returns to the default"


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        ("basicPeriod", 2000, "basicPeriod is 2000 ms, and must be from 1 to 1000 ms"),
        ("basicPeriod", True, "basicPeriod must be a whole number (ms), and is true"),
        ("basicPeriod", "5", "basicPeriod must be a whole number (ms), and is '5'"),
        ("basicPeriod", 1.5, "basicPeriod must be a whole number (ms), and is 1.5"),
        ("threshold", 1, "threshold is 1, and must be at least 0 and below 1"),
        ("threshold", float("nan"), "threshold must be a number, and is nan"),
        ("baudRate", 1, "baudRate is 1, and must be one of 9600, 115200"),
        ("handler", "Faul", "handler is 'Faul', and must be one of Dunkermotoren, Faulhaber"),
        ("motors[0].vel", 7, "motors[0].vel is 7 rad/s, and must be from 0 to 2 rad/s"),
        ("motors", [], "motors has 0 elements, and must have 1 to 3"),
        ("gains", [[1, 2]], "gains[0] has 2 elements, and must have exactly 3"),
        ("ids", [1, 2, 1], "ids contains 1 twice"),
        ("offsets", {"a b": "x"}, "offsets[\"a b\"] must be a number, and is 'x'"),
        ("motors[0]", {"name": "x"}, "motors[0].id has no value, and no default"),
        ("motors[7].vel", 1, "unknown parameter 'motors[7].vel'"),
        ("speed", 1, "unknown parameter 'speed'"),
        ("motors[0].speed", 1, "unknown parameter 'motors[0].speed'"),
        ("low", 2, "this must hold: low < high"),
        ("motors[0].max", -3.15, "a motor's min must be below its max"),
        ("class", "y", "class cannot be changed while the component runs: it is not editable"),
        ("Yolo.use_gpu", False, "Yolo.use_gpu cannot be changed while the component runs: it is not editable"),
    ],
)
def test_a_bad_value_changes_nothing(arm: Any, path: str, value: object, message: str) -> None:
    before = arm.now
    assert message in refused(lambda: arm.change({"basicPeriod": 1, path: value}))
    assert arm.now is before and arm.basicPeriod == 220


def test_an_error_names_value_and_parameter(arm: Any) -> None:
    from generated.runtime.semantics.problems import ParameterError

    with pytest.raises(ParameterError) as error:
        arm.set("basicPeriod", 2000)
    (problem,) = error.value.problems
    assert (error.value.parameter, problem.value, problem.wanted, problem.unit) == (
        "basicPeriod", "2000", "be from 1 to 1000 ms", "ms",
    )  # fmt: skip
    assert isinstance(error.value, ValueError)


def test_attributes_that_cannot_be_set(arm: Any) -> None:
    with pytest.raises(AttributeError, match="unknown parameter 'basicperiod'"):
        arm.basicperiod = 3
    with pytest.raises(AttributeError, match="use set"):
        arm.motors[0].vel = 1.0
    with pytest.raises(AttributeError):
        arm.now.basicPeriod = 3
    with pytest.raises(TypeError):
        arm.offsets["a"] = 1.0


def test_listeners_are_notified_in_order(arm: Any) -> None:
    told: list[Any] = []

    def follow(change: Any) -> None:
        told.append(change)
        if change.concerns("low"):
            arm.set("baudRate", 9600)  # a listener may change more

    def broken(change: Any) -> None:
        raise RuntimeError("a listener's own fault")

    for listener in (broken, follow):
        arm.listen(listener)
    arm.change({"low": -1, "motors[0].vel": 1.5})
    arm.set("low", -1)
    assert [change.paths for change in told] == [("motors[0].vel", "low"), ("baudRate",)], "what is the same is no news"
    assert (told[0].before.low, told[0].after.low) == (1, -1)
    assert told[0].concerns("motors") and not told[1].concerns("low")


def test_changes_are_atomic(arm: Any) -> None:
    """Two parameters that always change together are read while they change."""
    stop = threading.Event()

    def keep_changing() -> None:
        turn = 0
        while not stop.is_set():
            turn += 1
            arm.change({"low": turn, "high": turn + 1})

    thread = threading.Thread(target=keep_changing)
    thread.start()
    seen = [(now.low, now.high) for now in (arm.now for _ in range(2000))]
    stop.set()
    thread.join()
    assert all(high == low + 1 for low, high in seen)


def test_the_command_line_overrides_rows() -> None:
    arm = started(ARM, CONFIG, {"motors.0.vel": "1", "Arm.Device": "/dev/x", "low": "-7"})
    assert (arm.motors[0].vel, arm.motors[1].vel, arm.low) == (1.0, 1.0, -7)
    assert refused(lambda: started(ARM, CONFIG, {"motors.0.vel": "9"})) == [
        "motors[0].vel is 9 rad/s, and must be from 0 to 2 rad/s"
    ]


def test_all_errors_at_the_start_are_reported_together() -> None:
    config = {**CONFIG, "Arm.M0": "a,A", "basicPeriod": "0x10", "handler": "", "threshold": "1e0", "2d": "yes"}
    assert refused(lambda: started(ARM, config)) == [
        "handler is '', and must be one of Dunkermotoren, Faulhaber",
        "basicPeriod must be a whole number (ms), and is '0x10'",
        "threshold is 1e0, and must be at least 0 and below 1",
        "motors[0] must be a mapping of name, id, invertedSign, min, max, vel, and is 'a,A'",
        "2d must be true or false, and is 'yes'",
    ]


def test_references_to_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    """References are resolved at the start, and shown as references, even in errors."""
    monkeypatch.setenv("ARM_TOKEN", "s3cret")
    monkeypatch.setenv("ARM_PERIOD", "33")
    config = {**CONFIG, "token": "${env:ARM_TOKEN}", "basicPeriod": "${env:ARM_PERIOD}"}
    made = accessors.store(parameters(ARM)[0], config)
    assert (made.values.token, made.values.basicPeriod) == ("s3cret", 33)
    shown = [made.entries()[name].text for name in ("token", "basicPeriod")]
    assert shown == ["${env:ARM_TOKEN}", "${env:ARM_PERIOD}"]
    made.change({"low": 0})
    assert made.entries()["token"].text == "${env:ARM_TOKEN}"
    monkeypatch.setenv("ARM_PERIOD", "s3cret")
    assert refused(lambda: started(ARM, config)) == [
        "basicPeriod must be a whole number (ms), and is ${env:ARM_PERIOD}"
    ]
    monkeypatch.delenv("ARM_PERIOD")
    assert refused(lambda: started(ARM, config)) == [
        "basicPeriod comes from the environment variable ARM_PERIOD, which is not set"
    ]


def test_texts_of_all_values_can_be_read_back(arm: Any) -> None:
    """The result of getParameterList can be passed to setParameterList, unchanged or changed."""
    store = arm.__store__
    store.change_texts({key: entry.text for key, entry in store.entries().items()})
    store.change_texts({"motors.size": "1", "offsets.keys": "a%2Eb %", "offsets.a%2Eb": "1", "offsets.%": "2"})
    assert len(arm.motors) == 1 and dict(arm.offsets) == {"a.b": 1.0, "": 2.0}
    assert refused(lambda: store.change_texts({"low": "x", "nothing": "1"}))[0] == "unknown parameter 'nothing'"


@pytest.mark.parametrize("that", CONSTRAINTS)
def test_constraints_agree_with_check(that: str) -> None:
    """Even with missing values, and with divisions by zero."""
    made, faults = parameters(subject(that))
    assert not faults
    table = accessors.python(made).TABLE
    from generated.runtime.semantics import composite  # type: ignore[import-not-found]
    from generated.runtime.semantics.plain import Conversion  # type: ignore[import-not-found]

    kind = composite.RecordKind(table.values)
    for data in CASES:
        values = kind.convert(data, (), Conversion())
        (constraint,) = table.constraints
        assert constraint.holds(values) == evaluate.holds(made.constraints[0].expression, data), data


AWKWARD = """\
types:
  Literal: {enum: [None_, mro]}
  Values: {struct: {plain: bool, self: {type: string, pattern: '"[\\\\]+"'}, int: int}}
  Record: {struct: {float: {type: float, default: 1}}}
parameters:
  composite: {list: Values, default: []}
  set: {type: Literal, default: mro}
  now: {map: Record, default: {}}
  parameters: {group: {reading: {group: {from: {type: int, default: 1, doc: 'three \"\"\" of them'}}}}}
  bool: {type: bool, default: true}
  str: {type: string, default: "\\"\\\\' \\u00e9 \\x07"}
constraints:
  - {that: "all(p.self != 'x' for p in composite)", else: 'a "quoted" one'}
"""


def test_awkward_names_and_texts() -> None:
    made, faults = parameters(AWKWARD)
    assert not faults
    text = python_parameters.text(made, "X", "x.pdsl.yaml")
    ast.parse(text, feature_version=(3, 9))
    assert max(map(len, text.splitlines())) <= 120
    live = accessors.live(made, {"composite.0.int": "3", "composite.0.plain": "1", "composite.0.self": '"\\"'})
    assert (live.composite_[0].int, live.set_, live.parameters.reading.from_, live.bool) == (3, "mro", 1, True)
    assert live.str == "\"\\' \u00e9 \x07"
    live.listen(print)


def test_none_inside_a_value_is_the_default() -> None:
    text = """\
types: {Motor: {struct: {name: string, port: {type: string, optional: true}, vel: {type: float, default: 1}}}}
parameters:
  motors: {list: Motor, default: [], editable: true}
  by: {map: Motor, default: {}, editable: true}
"""
    live = accessors.live(parameters(text)[0], {})
    given = {"name": "a", "port": None, "vel": None}
    live.change({"motors": [given], "by": {"x": given, "y": None}})
    assert [(one.name, one.port, one.vel) for one in (*live.motors, *live.by.values())] == [("a", None, 1)] * 2
    assert list(live.by) == ["x"] and given == {"name": "a", "port": None, "vel": None}, "it is left as it is"
    for wrong in ([None], [{"name": None}], [{"name": "a", "prot": None}]):
        with pytest.raises(ValueError, match="motors"):
            live.set("motors", wrong)
