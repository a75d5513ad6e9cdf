"""Observations of an engine are shared by all tasks: one at a time, and a cancelled task does not cancel it."""

from __future__ import annotations

import asyncio
import time
from typing import cast

import pytest

from robocomp_yaml.deploy.carry_out import Watch
from robocomp_yaml.deploy.engine import KILLED, RUNNING, STOPPED, DeployFailed, Engine, Running
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.span import Span


class Slow:
    """A slow engine that counts its observations, and those in parallel. `state` is the state of its process."""

    def __init__(self) -> None:
        self.state, self.looks, self.at_once, self.most = STOPPED, 0, 0, 0
        self.fails = False

    async def observe(self, *, use: bool = False) -> dict[str, Running]:
        self.looks += 1
        self.at_once += 1
        self.most = max(self.most, self.at_once)
        seen = {"a": Running("a", None, "here", self.state)}
        await asyncio.sleep(0.05)
        self.at_once -= 1
        if self.fails:
            raise DeployFailed(deploying.NOT_SUPERVISED.at(Span("n.ddsl.yaml"), what=KILLED))
        return seen


def watch(engine: Slow) -> Watch:
    return Watch(cast("Engine", engine))


def test_one_observation_serves_all() -> None:
    async def look() -> None:
        of_a, now = watch(engine).of("a"), time.monotonic()
        found = await asyncio.gather(*(of_a(now) for _ in range(50)))
        assert {one.state for one in found if one} == {STOPPED}

    engine = Slow()
    asyncio.run(look())
    assert engine.looks == 1


def test_a_cancelled_task_does_not_cancel_the_observation() -> None:
    async def look() -> None:
        of_a, now = watch(engine).of("a"), time.monotonic()
        first, second = asyncio.ensure_future(of_a(now)), asyncio.ensure_future(of_a(now))
        await asyncio.sleep(0.01)
        first.cancel()
        found = await second
        assert found and found.state == STOPPED

    engine = Slow()
    asyncio.run(look())
    assert (engine.looks, engine.most) == (1, 1)


def test_an_observation_that_began_before_is_too_old() -> None:
    async def look() -> None:
        of_a = watch(engine).of("a")
        early = asyncio.ensure_future(of_a(time.monotonic()))
        await asyncio.sleep(0.01)
        engine.state = RUNNING
        found = await of_a(time.monotonic())
        assert found and found.state == RUNNING
        seen = await early
        assert seen and await of_a(0.0) == found

    engine = Slow()
    asyncio.run(look())
    assert (engine.looks, engine.most) == (2, 1)


def test_a_failure_reaches_all_tasks_and_the_next_observation_is_new() -> None:
    async def look() -> None:
        one, now = watch(engine), time.monotonic()
        engine.fails = True
        found = await asyncio.gather(*(one.of("a")(now) for _ in range(3)), return_exceptions=True)
        assert all(isinstance(each, DeployFailed) for each in found)
        engine.fails = False
        assert await one.of("a")(now) is not None
        await one.close()

    engine = Slow()
    asyncio.run(look())
    assert engine.looks == 2


def test_close_cancels_the_observation(capfd: pytest.CaptureFixture[str]) -> None:
    async def look() -> None:
        one = watch(engine)
        waiting = asyncio.ensure_future(one.of("a")(time.monotonic()))
        await asyncio.sleep(0.01)
        waiting.cancel()
        await one.close()

    engine = Slow()
    engine.fails = True
    asyncio.run(look())
    assert engine.at_once == 1 and capfd.readouterr().err == ""
