"""When a process is ready: what its document says, and by default what it serves."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.model.deployment import Ready
from robocomp_yaml.network.draft import Draft, Drafts, text_fault
from robocomp_yaml.network.network import Readiness, is_loopback
from robocomp_yaml.source.ice_options import InvalidIceText
from robocomp_yaml.source.ice_proxy import parse_proxy, reached_at

_LONGEST_SETTLED = 3.0  # seconds


def of_draft(draft: Draft) -> Readiness:
    """By default, everything that a component serves answers a ping. A program may not use Ice, so that only its first
    TCP port must be open."""
    given = draft.instance.entry.ready
    within = given.within if given and given.within is not None else Readiness().within
    if given and given.ping:
        return Readiness(within, (pinged(given, draft),))
    if given and (given.port is not None or given.command or given.log):
        return Readiness(within, (), given.port, given.command, given.log)
    if draft.instance.component is not None:
        return Readiness(within, tuple(offer.proxy for offer in draft.offers if offer.endpoint))
    ports = [offer.endpoint.port for offer in draft.offers if offer.endpoint and offer.endpoint.protocol != "udp"]
    return Readiness(within, port=ports[0] if ports else None)


def pinged(given: Ready, draft: Draft) -> str:
    """The proxy of `ping:`. What it says of this machine, or leaves open, is the process's host."""
    return reached_at(given.ping, draft.host.address, is_loopback)


def settled(given: Ready | None, ready: Readiness) -> float | None:
    """For a process without a condition, the time of its `ready:` is the time that it must run, up to some seconds."""
    if ready.has_condition or given is None or given.within is None:
        return None
    return min(given.within, _LONGEST_SETTLED)


def faults(drafts: Drafts) -> Iterator[Diagnostic]:
    """Texts of `ping:` that are no proxies, or have no address."""
    for draft in drafts.drafts.values():
        given = draft.instance.entry.ready
        if given is None or not given.ping:
            continue
        try:
            proxy = parse_proxy(given.ping)
        except InvalidIceText as refused:
            hint = 'write it in the syntax of Ice: `ping: "laser:tcp -p 10003"`'
            yield text_fault(codes.BAD_PROXY, draft, given.span, given.ping, refused, hint, text=given.ping)
            continue
        if not proxy.endpoints:
            hint = f'add it: `ping: "{proxy.identity}:tcp -p PORT"`'
            yield codes.PING_WITHOUT_ADDRESS.at(given.span, text=given.ping, hint=hint)
