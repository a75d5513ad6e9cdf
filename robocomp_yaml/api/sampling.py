"""The processes of a running deployment, sampled again and again."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Callable, Coroutine
from contextlib import aclosing
from functools import partial
from typing import Any

from robocomp_yaml.api.deploying import Deployment
from robocomp_yaml.deploy.engines import make_engine
from robocomp_yaml.deploy.ownership import NotOwn
from robocomp_yaml.deploy.sampling import NetworkSample, samples
from robocomp_yaml.diag.errors import Faulty

Show = Callable[[AsyncGenerator[NetworkSample, None]], Coroutine[Any, Any, None]]


def sample(deployment: Deployment, *names: str, every: float, show: Show) -> None:
    """Runs `show` with the samples of a deployment's processes, one each so many seconds, until it returns. The first
    one has no rates yet. The NAMEs are processes, their aliases or groups: Refused is raised if one is unknown, Faulty
    if another user runs them."""
    chosen = deployment.chosen(names)

    async def work() -> None:
        engine = partial(make_engine, deployment.engine, deployment.network)
        async with aclosing(samples(engine, deployment.network, chosen, every)) as found:
            await show(found)

    try:
        asyncio.run(work())
    except NotOwn as error:
        deployment.add([error.diagnostic])
        raise Faulty(deployment.diagnostics) from error
