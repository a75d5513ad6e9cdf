"""What is wrong with endpoints that a document spells, and with ports that are counted up."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.network import ice_texts
from robocomp_yaml.network.draft import Draft, Offer
from robocomp_yaml.network.drafts import Drafts
from robocomp_yaml.source.ice_endpoint import fixed_endpoint
from robocomp_yaml.source.ice_options import LAST_PORT, Refused


def endpoint_faults(drafts: Drafts) -> Iterator[Diagnostic]:
    for draft in drafts.drafts.values():
        for offer in draft.adapters:
            if offer.given:
                yield from _of_text(draft, offer)
            elif offer.number > LAST_PORT:
                yield codes.PORT_TOO_HIGH.at(
                    offer.span,
                    name=draft.name,
                    port=offer.number,
                    hint="begin with a lower one, or use fewer instances",
                )


def _of_text(draft: Draft, offer: Offer) -> Iterator[Diagnostic]:
    try:
        fixed_endpoint(offer.given)
    except Refused as refused:
        usual = f"write a protocol and a port from 1 to {LAST_PORT}, such as `tcp -p 10003`"
        yield codes.BAD_ENDPOINT.at(
            ice_texts.place(draft, offer.span, offer.given, refused),
            name=offer.adapter,
            text=offer.given,
            problem=refused.problem,
            hint=ice_texts.hint(draft, offer.given, refused, usual),
        )
