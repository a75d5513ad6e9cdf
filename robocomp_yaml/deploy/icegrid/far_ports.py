"""Ports of other hosts that are taken before what is to serve them starts: found by calling there.

Whatever answered at such a port would be taken for the process, which itself had failed.
"""

from __future__ import annotations

import asyncio
from collections.abc import Mapping, Sequence

from robocomp_yaml.deploy.engine import ENDED, GIVEN_UP, STOPPED, Running
from robocomp_yaml.deploy.readiness import listens
from robocomp_yaml.deploy.spec import Spec
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic

_WITHIN = 1.0  # seconds for an answer


async def taken(specs: Sequence[Spec], running: Mapping[str, Running]) -> list[Diagnostic]:
    """`specs` are to be started; what runs of the deployment itself is in nobody's way."""
    own = {
        (one.spec.address, endpoint.port)
        for one in running.values()
        if one.spec and one.state not in (STOPPED, ENDED, GIVEN_UP)
        for endpoint in one.spec.process.endpoints
    }
    asked = [
        (spec, endpoint)
        for spec in specs
        for endpoint in spec.process.endpoints
        if endpoint.port and endpoint.protocol != "udp" and (spec.address, endpoint.port) not in own
    ]
    answers = await asyncio.gather(*(listens(spec.address, endpoint.port, _WITHIN) for spec, endpoint in asked))
    return [
        deploying.PORT_TAKEN.at(
            endpoint.span if endpoint.span.file else spec.process.span,
            hint=f"`ss -ltnp` says there which; end it, or give '{spec.name}' another port",
            name=spec.name, port=endpoint.port, program=f"one on the host '{spec.process.host}'",
        )
        for (spec, endpoint), is_taken in zip(asked, answers, strict=True)
        if is_taken
    ]  # fmt: skip
