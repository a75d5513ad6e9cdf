"""What is wrong with endpoints that a document spells, and with ports that are counted up."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.network.drafts import Drafts

_LAST = 65535


def endpoint_faults(drafts: Drafts) -> Iterator[Diagnostic]:
    for draft in drafts.drafts.values():
        for offer in draft.adapters:
            if offer.endpoint is None:
                yield codes.BAD_ENDPOINT.at(
                    offer.span, name=offer.adapter, text=offer.given,
                    hint=f"write a protocol and a port from 1 to {_LAST}, such as `tcp -p 10003`",
                )
            elif offer.number > _LAST:
                yield codes.PORT_TOO_HIGH.at(
                    offer.span, name=draft.name, port=offer.number,
                    hint="begin with a lower one, or use fewer instances",
                )
