"""Topics in the manager: a real IceStorm, and a generated component that publishes."""

from __future__ import annotations

import shutil
import time
from pathlib import Path
from typing import Any

import pytest

from conftest import write_tree
from processes import Ports, Start, Storm, answers, until
from scenario import INTERFACES, cdsl
from test_manager import manager, read_events
from test_topic_commands import Rcyaml, Talk, rows, talk  # noqa: F401 (the fixture)


def test_listeners_get_messages_and_rates_are_known_while_somebody_listens(
    talk: Talk, start: Start, rcyaml: Rcyaml, tmp_path: Path  # noqa: F811
) -> None:  # fmt: skip
    start(talk.publisher.command).wait_for("Publisher is running")
    with manager(tmp_path, "robot.ddsl.yaml") as one:
        base = "/api/deployments/Robot"
        states = read_events(one.open(f"{base}/events"), "states")
        assert next(states)["topics"] == {}
        first, second = (one.open(f"{base}/topic?topic={talk.name}{method}") for method in ("", ".count"))
        assert first.status == second.status == 200
        counts = read_events(second, "message")
        found: list[Any] = [next(counts) for _ in range(5)]
        assert [one["value"]["n"] for one in found] == list(range(found[0]["value"]["n"], found[0]["value"]["n"] + 5))
        assert {(one["topic"], one["method"]) for one in found} == {(talk.name, "count")}
        assert abs(found[0]["time"] - time.time()) < 30
        moved = next(one for one in read_events(first, "message") if one["method"] == "moved")
        assert moved["value"]["pose"]["side"] == "right"
        assert rows(rcyaml)[talk.name]["subscribed"] == 1  # for both
        rate = next(one["topics"][talk.name]["rate"] for one in states if one["topics"].get(talk.name, {}).get("rate"))
        assert rate > 0
        one.close()
        until(lambda: rows(rcyaml)[talk.name]["subscribed"] == 0, "the end of the subscription", 10)


def test_an_icestorm_that_goes_away_is_said(
    ice: object, free_port: Ports, start: Start, rcyaml: Rcyaml, tmp_path: Path
) -> None:
    if shutil.which("icebox") is None:
        pytest.skip("icebox is not installed (Debian: zeroc-icebox, libzeroc-icestorm3.7)")
    (tmp_path / "storm").mkdir()
    storm = Storm.new(tmp_path / "storm", free_port(), free_port())
    write_tree(tmp_path, {
        **INTERFACES, "rcyaml.yaml": "interfaces: [.]\n",
        "s/s.cdsl.yaml": cdsl("Subscriber", subscribes=["ArmEvents"]),
        "s/etc/config": f"TopicManager.Proxy = {storm.manager}\n",
        "robot.ddsl.yaml": "deployment: Robot\ncomponents: {s: {component: s, config: etc/config}}\n",
    })  # fmt: skip
    running = start(storm.command)
    until(lambda: answers(ice, storm.manager), lambda: running.output)
    with manager(tmp_path, "robot.ddsl.yaml") as one:
        topic = "/api/deployments/Robot/topic?topic=ArmEvents"
        first = read_events(one.open(topic), "storm")
        running.process.kill()
        assert "nothing listens there; waiting until it does" in next(first)["text"]
        late = one.open(topic)  # a later listener is told, too
        assert "nothing listens there" in next(read_events(late, "storm"))["text"]
        running = start(storm.command)
        assert "answers again" in next(first)["text"]
        last = one.open(topic)  # what is over is no news
        options = ("--storm", storm.manager)
        assert rcyaml("topic", "pub", "ArmEvents.count", "n=1", *options).exit_code == 0
        assert b"event: message" in b"".join(next(iter(last)) for _ in range(4))


def test_topics_that_are_unknown_or_not_served(talk: Talk, tmp_path: Path) -> None:  # noqa: F811
    with manager(tmp_path, "robot.ddsl.yaml", "--read-only") as one:
        status, answer = one.robot(f"topic?topic={talk.name}x")
        assert (status, "did you mean" in answer["error"]) == (400, True)
        assert one.robot("topic")[0] == 400
        for folder in "ps":
            (tmp_path / folder / "etc" / "config").write_text("TopicManager.Proxy = IceStorm/TopicManager:tcp -p 1\n")
        status, answer = one.robot(f"topic?topic={talk.name}")
        assert (status, "IceStorm" in answer["error"]) == (502, True)
