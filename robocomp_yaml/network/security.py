"""Who controls a deployment, and what of it talks over TLS, as its document says; and what that does not cover."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from robocomp_yaml.diag.codes import networks as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.model.deployment import OPEN, PLAIN, TLS, TOKEN
from robocomp_yaml.network.draft import Draft, Drafts
from robocomp_yaml.network.listening import SSL
from robocomp_yaml.network.network import Connection

_PROGRAM = "it is a program, and rcyaml does not know how it reads certificates"


def faults(drafts: Drafts, connections: Iterable[Connection]) -> Iterator[Diagnostic]:
    own = drafts.linked.deployment
    if own.control == OPEN:
        yield codes.OPEN_CONTROL.at(own.control_span, name=own.name)
    for document in drafts.linked.documents:
        if document is own:
            continue
        demands = (
            ("security", document.security, TLS, own.security or PLAIN, document.security_span),
            ("control", document.control, TOKEN, own.control or TOKEN, document.control_span),
        )
        for key, value, strict, decided, span in demands:
            if value == strict != decided:
                yield codes.INCLUDED_SECURITY.at(
                    span, key=key, value=value, document=own.path, hint=f"write `{key}: {value}` there, too",
                    related=[Related("it includes this document", own.span)],
                )  # fmt: skip
    if own.security == TLS:
        yield from _plain(drafts, connections)


def _plain(drafts: Drafts, connections: Iterable[Connection]) -> Iterator[Diagnostic]:
    """What does not talk over TLS, and what that cannot call."""
    plain = {draft.name: draft for draft in drafts.drafts.values() if draft.protocol != SSL}
    secured = {draft.name for draft in drafts.drafts.values() if draft.protocol == SSL}
    secured |= {storm.name for storm in drafts.storms.values()}
    for name, draft in plain.items():
        if draft.instance.component is not None or draft.offers:
            yield codes.STAYS_PLAIN.at(draft.span, name=name, why=_why(draft))
    for one in connections:
        if one.source in plain and one.target in secured:
            source = plain[one.source]
            found = codes.CANNOT_CALL.at(
                one.span, source=one.source, target=one.target, interface=one.topic or one.interface, why=_why(source)
            )
            yield found if source.instance.component is None else found.as_severity("error")


def _why(draft: Draft) -> str:
    component = draft.instance.component
    return f"components in {component.component.language.target.title} have no TLS" if component else _PROGRAM
