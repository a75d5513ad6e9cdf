"""Processes that run as long as a context lasts, for a program that is not a deployment itself."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from robocomp_yaml.deploy import operations
from robocomp_yaml.deploy.engine import DeployFailed
from robocomp_yaml.deploy.local.engine import LocalEngine
from robocomp_yaml.diag.errors import Faulty
from robocomp_yaml.network.network import Network


@contextmanager
def beside(network: Network) -> Iterator[None]:
    """Starts the processes of a network, and stops them at the end, also if this process is killed. Raises Faulty if
    one does not become ready."""
    engine = LocalEngine(tied=True)

    async def start() -> None:
        try:
            await engine.open(network, create=True)
            result = await operations.up(
                engine, network, (), (), operations.always(operations.STOP_THEM), lambda event: None
            )
        except DeployFailed as error:
            raise Faulty([error.diagnostic]) from error
        if result.diagnostics:
            await engine.close(end=True)
            raise Faulty(result.diagnostics)

    async def stop() -> None:
        with suppress(DeployFailed):
            await operations.down(engine, (), lambda event: None, network.folder)

    with asyncio.Runner() as runner:
        runner.run(start())
        try:
            yield
        finally:
            runner.run(stop())
