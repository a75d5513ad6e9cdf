"""What a generated component says of itself, asked while it runs (`wire/introspection.py`)."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec

from robocomp_yaml.deploy import ice_call
from robocomp_yaml.deploy.ice_call import IceCall
from robocomp_yaml.source.ice_proxy import proxy_at
from robocomp_yaml.wire import introspection as wire
from robocomp_yaml.wire.introspection import FAILED, RUNNING, STARTING, STATE, STOPPING, WAITING, Sections
from robocomp_yaml.wire.protocol import NO_FACET, NO_OBJECT, NO_OPERATION, OK, Reply


class NoFacet(Exception):
    """The object answers, and does not describe itself: the program is not a component that rcyaml generated, or an
    earlier version generated it."""


class OwnState(msgspec.Struct, frozen=True):
    """The state of a component: `state` and `since` (seconds); what it `waits_for`, `at` which proxy, and `why` that
    does not answer, or why it failed; `inside` is the user's method that it executes."""

    state: str
    since: float = 0.0
    waits_for: str = ""
    at: str = ""
    why: str = ""
    inside: str = ""

    @property
    def is_running(self) -> bool:
        return self.state == RUNNING

    @property
    def words(self) -> str:
        """What it does, as a predicate without a subject."""
        if self.state == WAITING:
            return f"waiting for {self.waits_for} at {_place(self.at)}"
        if self.state == STARTING and self.inside:
            return f"starting: in {self.inside} for {self.since:.0f} s"
        if self.state == FAILED and self.why:
            return f"{FAILED}: {self.why}"
        return self.state if self.state in (STARTING, STOPPING, FAILED, RUNNING) else f"in the state '{self.state}'"


def _place(proxy: str) -> str:
    """The host and port of a proxy's first endpoint; the proxy if that has none."""
    found = proxy_at(proxy)
    first = found.endpoints[0] if found and found.endpoints else None
    if first is None:
        return proxy
    host = first.host or "localhost"
    return f"[{host}]:{first.port}" if ":" in host else f"{host}:{first.port}"


async def report(proxy: str, sections: Iterable[str], within: float, pem: str = "") -> Sections | None:
    """What a component says in these sections, in all without `sections`; None if it does not answer within so many
    seconds. `pem` are a key and the certificates for a component over TLS. Raises NoFacet."""
    call = IceCall(wire.REPORT, wire.FACET, wire.names(sections))
    return sections_in(await ice_call.answer(proxy, call, within, pem))


def sections_in(reply: Reply | None) -> Sections | None:
    """The sections in an answer to `report`; None without an answer. Raises NoFacet."""
    result = _result(reply)
    try:
        return None if result is None else wire.sections_of(result)
    except ValueError as error:
        raise NoFacet from error


async def state(proxy: str, within: float, pem: str = "") -> OwnState | None:
    """The state of a component; None if it does not answer. Raises NoFacet."""
    sections = await report(proxy, [STATE], within, pem)
    if sections is None:
        return None
    if (found := state_in(sections)) is None:
        raise NoFacet
    return found


def state_in(sections: Sections) -> OwnState | None:
    """The state in what a component says; None if it is not in these sections."""
    if not sections.get(STATE):
        return None
    facts = sections[STATE][0]
    return OwnState(
        facts.texts.get("state", ""),
        round(facts.numbers.get("since", 0.0), 3),
        facts.texts.get("for", ""),
        facts.texts.get("at", ""),
        facts.texts.get("why", ""),
        facts.texts.get("in", ""),
    )


def _result(reply: Reply | None) -> bytes | None:
    if reply is not None and reply.status in (NO_OBJECT, NO_FACET, NO_OPERATION):
        raise NoFacet
    return reply.result if reply is not None and reply.status == OK else None
