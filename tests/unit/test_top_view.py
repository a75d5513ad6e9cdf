"""What `rcyaml top` shows: a table that fits every terminal, in an order, with unknown values as such."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from robocomp_yaml.commands import _screen
from robocomp_yaml.commands._top_view import DOCUMENT, ORDERS, TopView, as_data, in_order
from robocomp_yaml.commands.top import SORTS
from robocomp_yaml.deploy.sampling import MethodUse, NetworkSample, ProcessSample, TopicUse, WorkerUse
from robocomp_yaml.diag.terminal import columns

ARM = ProcessSample(
    "arm", "onboard", "running", False, 71, 12.0, 0, 40 << 20, 0.25, True, WorkerUse(0.05, 0.0712, 900, 12),
    (MethodUse("Arm.move", 7, 1, 0.002, 0.0081, 3.5), MethodUse("Arm.stop", 1, 0, 1.2, 1.25, 0.0)),
    (TopicUse("robot/Joints", "out", 400, 99.97), TopicUse("Stop", "in", 2, None)),
)  # fmt: skip
HANGS = replace(ARM, name="hangs", pid=72, cpu=None, memory=None, worker=None, methods=None, topics=None)
FOREIGN = ProcessSample("lidar", "onboard", "running", False, 73, 7300.0, 2, 3 << 20, 1.5, False)
DEAD = ProcessSample("dead", "onboard", "given up: exit code 3", True, None, None, 5, None, None, True)


def sample(*processes: ProcessSample, problem: str = "") -> NetworkSample:
    return NetworkSample(problem, processes)


def rows(*processes: ProcessSample, sort: str = DOCUMENT) -> dict[str, str]:
    """The whole lines, by the name of the process."""
    lines = TopView("Robot", sort, False).lines(sample(*processes))
    return {line.split()[0]: line for line in lines[1:]}


def test_what_a_component_says() -> None:
    line = rows(ARM)["arm"]
    cells = ["running", "71", "12 s", "25 %", "40 MiB", "50 ms", "71 ms", "12", "3.5/s", "Arm.stop 1.2 s"]
    assert [cell.strip() for cell in line.split("  ") if cell.strip()] == [
        "arm", *cells, "robot/Joints 100/s out, Stop ?/s in",
    ]  # fmt: skip


def test_unknown_is_neither_nothing_nor_absent() -> None:
    shown = rows(HANGS, FOREIGN, DEAD)
    assert shown["hangs"].split()[5:] == ["unknown"] * 8
    assert shown["lidar"].split()[-8:] == ["3", "MiB", *"------"]
    assert "unknown" not in shown["lidar"] and "unknown" not in shown["dead"]
    assert " 0 " not in shown["hangs"] + shown["dead"]
    data = {one["name"]: one for one in as_data("Robot", "local", sample(HANGS, FOREIGN, DEAD))["processes"]}
    for name, key in (("hangs", "cpu"), ("hangs", "memory"), ("hangs", "calls"), ("lidar", "worker"), ("dead", "pid")):
        assert data[name][key] is None


def test_the_host_is_shown_if_there_are_several() -> None:
    assert "onboard" not in rows(ARM, DEAD)["arm"]
    assert "onboard" in rows(ARM, replace(DEAD, host="head"))["arm"]


@pytest.mark.parametrize(
    ("sort", "names"),
    [
        ("document", "arm hangs lidar dead"), ("name", "arm dead hangs lidar"), ("state", "dead arm hangs lidar"),
        ("cpu", "lidar arm hangs dead"), ("memory", "arm lidar hangs dead"), ("slowest", "arm hangs lidar dead"),
        ("topics", "arm hangs lidar dead"),
    ],
)  # fmt: skip
def test_orders(sort: str, names: str) -> None:
    assert [one.name for one in in_order([ARM, HANGS, FOREIGN, DEAD], sort)] == names.split()


def test_reversed_orders_keep_the_unknown_last() -> None:
    assert [one.name for one in in_order([ARM, HANGS, FOREIGN], "cpu", is_reversed=True)] == ["arm", "lidar", "hangs"]
    assert [one.name for one in in_order([ARM, FOREIGN], "document", is_reversed=True)] == ["lidar", "arm"]


def test_the_orders_of_the_option_have_a_key_each() -> None:
    assert list(ORDERS) == list(SORTS)
    assert len({one.key for one in ORDERS.values()} | {"r", "q"}) == len(ORDERS) + 2


@pytest.mark.parametrize("color", [False, True])
@pytest.mark.parametrize("width", [1, 5, 20, 40, 60, 80, 100, 140, 300])
def test_no_line_is_wider_than_the_terminal(width: int, color: bool) -> None:
    long = replace(
        DEAD, name="a-component-with-a-very-long-name", state="not alive: its worker has shown no life for 9 s"
    )
    found = sample(ARM, HANGS, long, problem="the registry of the deployment does not answer " * 3)
    for line in TopView("Robot (local)", "cpu", color).screen(found, width, 24):
        plain = line
        for part in ("\x1b[31m", "\x1b[32m", "\x1b[33m", "\x1b[2m", "\x1b[0m"):
            plain = type(line)(plain.replace(part, ""))
        assert columns(plain) <= max(1, width - 1)


def test_a_narrow_terminal_names_what_it_omits() -> None:
    lines = TopView("Robot", DOCUMENT, False).screen(sample(ARM, FOREIGN), 60, 24)
    assert lines[1].split()[:2] == ["PROCESS", "STATE"] and "CPU" in lines[1] and "TOPICS" not in lines[1]
    assert lines[-1].startswith("too narrow for PID, UP,")


def test_many_processes_scroll() -> None:
    found = sample(*(replace(FOREIGN, name=f"p{number}") for number in range(200)))
    view = TopView("Robot", DOCUMENT, False)

    def names() -> list[str]:
        lines = view.screen(found, 120, 14)
        assert len(lines) == 14
        return [line.split()[0] for line in lines[2:-1]]

    assert names() == [f"p{number}" for number in range(11)]
    assert view.screen(found, 120, 14)[-1].startswith("1 to 11 of 200: arrows and PageDown scroll")
    for key, first in ((_screen.DOWN, 1), (_screen.PAGE_DOWN, 12), (_screen.UP, 11), (_screen.END, 189),
                       (_screen.DOWN, 189), (_screen.PAGE_UP, 178), (_screen.HOME, 0), (_screen.UP, 0)):  # fmt: skip
        view.key(key)
        assert names()[0] == f"p{first}"
    assert len(view.screen(found, 120, 3)) == 3
    assert len(view.screen(found, 120, 1)) == 1


def test_keys_change_the_order() -> None:
    view = TopView("Robot", DOCUMENT, False)
    for key, first in (("c", "lidar"), ("m", "arm"), ("r", "lidar"), ("n", "arm"), ("z", "arm"), ("d", "arm")):
        view.key(key)
        assert view.screen(sample(ARM, FOREIGN), 200, 24)[2].split()[0] == first


def test_typed_sequences() -> None:
    assert _screen.keys_in("c\x1b[B\x1b[6~\x1bOAé\x1b[99~") == [
        "c", _screen.DOWN, _screen.PAGE_DOWN, _screen.UP, "é", "",
    ]  # fmt: skip
