"""Topics in the manager: a real IceStorm, and a generated component that publishes."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

from processes import Start, until
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


def test_topics_that_are_unknown_or_not_served(talk: Talk, tmp_path: Path) -> None:  # noqa: F811
    with manager(tmp_path, "robot.ddsl.yaml", "--read-only") as one:
        status, answer = one.robot(f"topic?topic={talk.name}x")
        assert (status, "did you mean" in answer["error"]) == (400, True)
        assert one.robot("topic")[0] == 400
        for folder in "ps":
            (tmp_path / folder / "etc" / "config").write_text("TopicManager.Proxy = IceStorm/TopicManager:tcp -p 1\n")
        status, answer = one.robot(f"topic?topic={talk.name}")
        assert (status, "IceStorm" in answer["error"]) == (502, True)
