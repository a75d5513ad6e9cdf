"""How it is checked that processes answer while they run: `alive:` of a deployment and its entries."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from robocomp_yaml.addresses.port_numbers import COMMON_BEHAVIOR
from robocomp_yaml.diag.codes import deploying as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.model.deployment import Alive
from robocomp_yaml.network import ready_when
from robocomp_yaml.network.draft import Draft, Drafts
from robocomp_yaml.network.network import AUTO, FOREVER, Liveness

_KEYS = ("every", "within", "misses", "restarts", "worker")


def introspection(draft: Draft) -> str:
    """The proxy of the object with which a component describes itself, '' for other programs. It is CommonBehavior's,
    unless the component implements that itself."""
    own = (offer for offer in draft.offers if offer.interface == COMMON_BEHAVIOR and offer.port is None)
    return next((offer.proxy for offer in own if draft.instance.component is not None and offer.endpoint), "")


def of_draft(draft: Draft) -> Liveness | None:
    """The entry's keys have precedence over those of its deployment, which are for components only. None if nothing is
    asked."""
    layers, is_component = _layers(draft), draft.instance.component is not None
    asked = _asked(draft)
    if not asked or not _is_on(layers, is_component):
        return None
    keys: dict[str, Any] = {}
    for layer in layers:
        keys |= {key: getattr(layer, key) for key in _KEYS if getattr(layer, key) is not None}
    worker = keys.pop("worker", None) if is_component else math.inf
    return Liveness(asked, **keys, worker=AUTO if worker is None else FOREVER if math.isinf(worker) else worker)


def faults(drafts: Drafts) -> Iterator[Diagnostic]:
    """Processes that should be asked, and serve nothing that could answer."""
    for draft in drafts.drafts.values():
        alive = draft.instance.entry.alive
        if alive is not None and _is_on([alive], False) and not _asked(draft) and not draft.instance.broken:
            hint = "add `endpoints: {Laser: tcp -p 10003}` with what it serves over Ice, or remove `alive:`"
            yield codes.NOBODY_TO_ASK.at(alive.span, name=draft.name, hint=hint)


def _layers(draft: Draft) -> list[Alive]:
    given = draft.instance.document.alive if draft.instance.component is not None else None
    return [layer for layer in (given, draft.instance.entry.alive) if layer is not None]


def _is_on(layers: list[Alive], is_on: bool) -> bool:
    for layer in layers:
        is_on = True if layer.is_on is None else layer.is_on
    return is_on


def _asked(draft: Draft) -> str:
    """The proxy of the object that is asked, '' if there is none."""
    served = (offer.proxy for offer in draft.offers if offer.endpoint and offer.endpoint.protocol != "udp")
    ready = draft.instance.entry.ready
    return introspection(draft) or (ready_when.pinged(ready, draft) if ready and ready.ping else next(served, ""))
