"""Obstacles that only the engine icegrid has: what this machine lacks, and the ports and configurations of other
hosts."""

from __future__ import annotations

import asyncio
import importlib.util
import shutil
from collections.abc import Mapping, Sequence

from robocomp_yaml.deploy.engine import STOPPED, Running
from robocomp_yaml.deploy.here import is_near
from robocomp_yaml.deploy.readiness import listens
from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.deploy.states import OVER
from robocomp_yaml.diag import extras
from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.network import Network

_TOO_LONG = "its configuration is longer than the 100,000 bytes that IceGrid carries to another host"


def too_long(specs: Sequence[ProcessSpec]) -> list[Diagnostic]:
    """Diagnostics for processes on other hosts, whose configurations are too long for IceGrid."""
    from robocomp_yaml.deploy.icegrid.descriptors import LONGEST_CONFIG, encoded

    return [
        deploying.CANNOT.at(spec.process.span, name=spec.name, what="started", reason=_TOO_LONG)
        for spec in specs
        if (config := spec.process.config) and not is_near(spec)
        and len(encoded(config.text).encode()) > LONGEST_CONFIG
    ]  # fmt: skip


def missing() -> str:
    """What the engine needs and this machine lacks, or ''."""
    # Ice's compiled module works only with the Python that it was compiled for.
    if not all(map(importlib.util.find_spec, ("Ice", "IceGrid", "IcePy"))):
        return f"Ice for Python is not installed (`{extras.command('ice')}`, Debian: python3-zeroc-ice)"
    for program, package in (("icegridregistry", "zeroc-icegrid"), ("icegridnode", "zeroc-icegrid"),
                             ("openssl", "openssl"), ("setpriv", "util-linux")):  # fmt: skip
        if shutil.which(program) is None:
            return f"{program} is not installed (Debian: {package})"
    return ""


_WITHIN = 1.0  # seconds for an answer


async def used_ports(specs: Sequence[ProcessSpec], running: Mapping[str, Running]) -> list[Diagnostic]:
    """Diagnostics for ports of `specs` on which something listens. Ports of the deployment's own processes are
    ignored."""
    own = {
        (one.spec.address, endpoint.port)
        for one in running.values()
        if one.spec and one.state not in (STOPPED, *OVER)
        for endpoint in one.spec.process.listening
    }
    ports = [
        (spec, endpoint)
        for spec in specs
        for endpoint in spec.process.listening
        if endpoint.port and endpoint.protocol != "udp" and (spec.address, endpoint.port) not in own
    ]
    answers = await asyncio.gather(*(listens(spec.address, endpoint.port, _WITHIN) for spec, endpoint in ports))
    return [
        deploying.PORT_TAKEN.at(
            endpoint.span if endpoint.span.file else spec.process.span,
            hint=f"`ss -ltnp` shows it on that host; end it, or choose another port for '{spec.name}'",
            name=spec.name, port=endpoint.port, program=f"a program on the host '{spec.process.host}'",
        )
        for (spec, endpoint), is_taken in zip(ports, answers, strict=True)
        if is_taken
    ]  # fmt: skip


def not_reached(network: Network, host: str, names: Sequence[str]) -> Diagnostic:
    """The diagnostic for a host that does not answer while these processes, or only its node, are to be ended."""
    one = network.hosts.get(host)
    what = " and ".join(f"'{name}'" for name in names) or "its node"
    reason = f"it does not answer; {what} there is ended as soon as it does"
    where = one.span if one and one.span.file else Span(network.path)
    return deploying.NO_NODE.at(where, name=host, address=one.address if one else "", reason=reason, hint="")
