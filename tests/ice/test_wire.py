"""Interfaces without generated code, against what slice2py generates: what one sends the other receives."""

from __future__ import annotations

import json
import struct
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from in_memory import program
from processes import killed_on_failure
from robocomp_yaml.emit import slice as target
from robocomp_yaml.source.tree import Mapping, parse
from robocomp_yaml.source.yaml_text import flow

PEER = Path(__file__).with_name("wire_peer.py")
DOCUMENTS = {
    "Others.idsl.yaml": """\
module: WireOthers
types:
  Side: {enum: {left: 3, right: {value: 7, doc: Not left.}, None: 9}}
  Place: {struct: {row: short, side: Side}}
""",
    "Wire.idsl.yaml": """\
module: WireModule
imports: [Others]
types:
  Bytes: {sequence: byte}
  Places: {sequence: Others.Place}
  Grid: {sequence: Places}
  ByName: {map: {key: string, value: Bytes}}
  ByNumber: {map: {key: long, value: double}}
  ByTruth: {map: {key: bool, value: int}}
  BySide: {map: {key: Others.Side, value: string}}
  ByPlace: {map: {key: Others.Place, value: float}}
  All:
    struct:
      truth: bool
      lambda: byte
      number: long
      real: float
      exact: double
      text: string
      grid: Grid
      byName: ByName
      byNumber: ByNumber
      byTruth: ByTruth
      bySide: BySide
      byPlace: ByPlace
exceptions:
  Jammed: {struct: {where: Others.Place, why: string}}
interfaces:
  Wire:
    methods:
      echo: {in: {value: All, times: int}, out: {same: All, counted: short}, returns: string}
      def: {idempotent: true, returns: Bytes}
      fail: {in: {why: string}, throws: [Jammed]}
      silent:
""",
}

names = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=8)
floats = st.floats(width=32, allow_nan=False) | st.sampled_from([0.1, 1e-40, -0.0])
sides = st.sampled_from(["left", "right", "None"])
places = st.fixed_dictionaries({"row": st.integers(-(2**15), 2**15 - 1), "side": sides})
listings = st.lists(st.integers(0, 255), max_size=5)
everything = st.fixed_dictionaries(
    {
        "truth": st.booleans(),
        "lambda": st.integers(0, 255),
        "number": st.integers(-(2**63), 2**63 - 1),
        "real": floats,
        "exact": st.floats(allow_nan=False),
        "text": names,
        "grid": st.lists(st.lists(places, max_size=3), max_size=3),
        "byName": st.dictionaries(names, listings, max_size=3),
        "byNumber": st.dictionaries(st.integers(-(2**63), 2**63 - 1).map(str), st.floats(allow_nan=False), max_size=3),
        "byTruth": st.dictionaries(st.sampled_from(["true", "false"]), st.integers(-9, 9)),
        "bySide": st.dictionaries(sides, names),
        "byPlace": st.lists(st.fixed_dictionaries({"key": places, "value": st.just(2.5)}), max_size=1),
    }
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("slice")
    for scope in program(DOCUMENTS).modules.values():
        (folder / target.file_name(scope)).write_text(target.text(scope))
    return folder


@pytest.fixture(scope="module")
def interface(ice: Any) -> Any:
    """The interface, made from its document; `ice`, since it needs Ice for Python."""
    from robocomp_yaml.wire.interfaces import WireInterface
    from robocomp_yaml.wire.types import Types

    scopes = {scope.module.name: scope for scope in program(DOCUMENTS).modules.values()}
    scope = scopes["WireModule"]
    return WireInterface(scope, scope.module.interfaces[0], Types())


@pytest.fixture(scope="module")
def servant(ice: Any, folder: Path) -> Iterator[Any]:
    """A proxy of the peer's servant."""
    command = [sys.executable, PEER, folder]
    with killed_on_failure(subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)) as peer:
        assert peer.stdin is not None and peer.stdout is not None
        yield ice.stringToProxy(peer.stdout.readline().strip())
        peer.stdin.close()


def node(data: object) -> Mapping:
    root, faults = parse("arguments", flow(data))
    assert isinstance(root, Mapping), faults
    return root


def right(fault: object) -> None:
    raise AssertionError(fault)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(everything, st.integers(-(2**31), 2**31 - 1))
def test_a_generated_servant_returns_what_was_sent(interface: Any, servant: Any, value: Any, times: int) -> None:
    operation = interface.operations["echo"]
    arguments = operation.arguments(node({"value": value, "times": times}), right)
    results = operation.results_as_data(operation.ice.invoke(servant, (arguments, None)))
    real = results["same"].pop("real")
    assert struct.pack("<f", real) == struct.pack("<f", value["real"])
    assert results == {"returns": str(times), "same": {n: v for n, v in value.items() if n != "real"}, "counted": 1}


def test_a_float_is_as_short_as_it_can_be(interface: Any, servant: Any) -> None:
    value = interface.operations["echo"].inputs.types["value"]
    kept = {name: value.members.types[name].to_data(zero) for name, zero in zeros(value).items()}
    operation = interface.operations["echo"]
    arguments = operation.arguments(node({"value": {**kept, "real": 0.1}, "times": 0}), right)
    results = operation.results_as_data(operation.ice.invoke(servant, (arguments, None)))
    assert results["same"]["real"] == 0.1


def zeros(value: Any) -> dict[str, Any]:
    return {name: type_.zero() for name, type_ in value.members.types.items()}


def test_a_generated_client_gets_its_results(ice: Any, interface: Any, folder: Path) -> None:
    calls = []

    def answer(operation: Any, arguments: tuple[Any, ...]) -> Any:
        calls.append((operation.name, operation.inputs_as_data(arguments)))
        if operation.name == "fail":
            raise operation.throws["Jammed"].make(
                node({"where": {"row": 3, "side": "right"}, "why": "sand"}), (), right
            )
        if operation.name == "echo":
            return operation.as_result({"returns": "r", "same": arguments[0], "counted": 4})
        return operation.as_result({name: type_.zero() for name, type_ in operation.results.items()})

    adapter = ice.createObjectAdapterWithEndpoints("", "tcp -h 127.0.0.1 -p 0")
    proxy = adapter.addWithUUID(interface.servant(answer))
    adapter.activate()
    try:
        peer = subprocess.run([sys.executable, PEER, folder, str(proxy)], capture_output=True, text=True, timeout=30)
    finally:
        adapter.destroy()
    assert peer.returncode == 0, peer.stderr
    assert json.loads(peer.stdout) == {
        "is one": True,
        "jammed": [3, "right", "sand"],
        "def": [],
        "silent": None,
        "echo": ["r", "hällo", True, [1, 255], 4],
    }
    assert [name for name, _ in calls] == ["fail", "def", "silent", "echo"]
    assert calls[-1][1]["value"]["grid"] == [[{"row": 1, "side": "left"}]]
    assert calls[-1][1]["value"]["byName"] == {"": [1, 255]}


def test_declared_exceptions_arrive_with_their_members(interface: Any, servant: Any) -> None:
    operation = interface.operations["fail"]
    thrown = operation.throws["Jammed"]
    with pytest.raises(thrown.kind) as jammed:
        operation.ice.invoke(servant, (operation.arguments(node({"why": "sand"}), right), None))
    assert thrown.members.to_data(jammed.value) == {"where": {"row": 0, "side": "left"}, "why": "sand"}


@pytest.mark.parametrize(
    ("wrong", "path", "problem"),
    [
        ({"times": 1.5}, "times", "must be a whole number, but is 1.5"),
        ({"times": 2**31}, "times", "must be from -2147483648 to 2147483647 (int), but is 2147483648"),
        ({"times": True}, "times", "must be a whole number, but is true"),
        ({"times": None}, "times", "must be a whole number, but is null"),
        ({"tiems": 1}, "tiems", "is unknown"),
        ({"value": 3}, "value", "must be a mapping of truth, lambda, "),
        ({"value": {"text": 3}}, "value.text", "must be text, but is 3"),
        ({"value": {"real": 1e39}}, "value.real", "must be a number that a float can hold, but is 1e+39"),
        ({"value": {"byName": {"a": [256]}}}, "value.byName.a[0]", "must be from 0 to 255 (byte), but is 256"),
        ({"value": {"bySide": {"lefft": ""}}}, "value.bySide.lefft", "must be one of left, right, None, but is lefft"),
        ({"value": {"byTruth": {"maybe": 1}}}, "value.byTruth.maybe", "must be true or false, but is maybe"),
        ({"value": {"byPlace": [{"key": {"row": 1}}]}}, "value.byPlace[0]", "must be {key: …, value: …}, but is a mapping"),
        ({"value": {"grid": [[{"row": 1}]]}}, "value.grid[0][0].side", "is missing"),
    ],
)  # fmt: skip
def test_wrong_arguments_are_reported_with_their_path(interface: Any, wrong: Any, path: str, problem: str) -> None:
    faults: list[Any] = []
    interface.operations["echo"].arguments(node(wrong), faults.append)
    assert [fault for fault in faults if fault.path == path and fault.problem.startswith(problem)], faults
