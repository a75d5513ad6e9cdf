"""What a process depends on, once its connections are resolved: causes for a memory of processes."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from msgspec.structs import astuple

from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.draft import Draft, LocatedText, Offer
from robocomp_yaml.source.disk import Disk


def causes_of(draft: Draft, external: Collection[str], disk: Disk) -> tuple[object, ...]:
    """All that the configuration and the process of a draft depend on. `external` are its proxies of servers outside.
    What is linked or built from an unchanged part of a document is the same object after an edit elsewhere."""
    instance, base, host = draft.instance, draft.base, draft.host
    document, flat = instance.document, base.flat
    return (
        disk.version,
        instance.entry,
        instance.number,
        instance.component,
        instance.values,
        instance.folder,
        instance.host,
        host.name,
        host.address,
        host.python,
        document.path,
        document.alive,
        document.limits,
        base.is_own,
        None
        if flat is None
        else (flat.path, flat.text, flat.is_written, flat.is_unchanged, *sorted(flat.base.items())),
        draft.protocol,
        *draft.listening.addresses,
        *sorted(external),
        *(group.name for group in instance.groups),
        *((alias.name, alias.entry) for alias in draft.aliases),
        *_of_offers(draft.offers),
        None,
        *_of_offers(draft.subscribers),
        *_located(draft.proxies.items()),
        None,
        *_located(draft.topics.items()),
        *(_located([("", draft.manager)]) if draft.manager is not None else ()),
    )


def _of_offers(offers: Iterable[Offer]) -> Iterator[object]:
    for one in offers:
        yield from (one.adapter, one.port, one.number, one.explicit, _place(one.span), _place(one.own))


def _located(texts: Iterable[tuple[str, LocatedText]]) -> Iterator[object]:
    for name, one in texts:
        yield from (name, one.text, _place(one.span))


def _place(span: Span | None) -> tuple[object, ...] | None:
    return astuple(span) if span is not None else None
