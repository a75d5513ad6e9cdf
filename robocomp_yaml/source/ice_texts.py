"""Endpoints and proxies in documents: what Ice would reject, at its location."""

from __future__ import annotations

from robocomp_yaml.diag.codes.files import BAD_ICE_TEXT
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source.ice_endpoint import parse_endpoints
from robocomp_yaml.source.ice_options import InvalidIceText
from robocomp_yaml.source.ice_proxy import parse_proxy
from robocomp_yaml.source.tree import Scalar

ENDPOINT, PROXY = "endpoint", "proxy"
_SUCH_AS = {ENDPOINT: "tcp -p 10001", PROXY: '"mouth:tcp -h localhost -p 10002"'}


def of_text(what: str, node: Scalar) -> Diagnostic | None:
    """What is wrong with an ENDPOINT, or with a PROXY."""
    text = unquoted(node.lexeme)
    try:
        if what == ENDPOINT:
            parse_endpoints(text)
        else:
            parse_proxy(text)
    except InvalidIceText as refused:
        meant = did_you_mean(text[refused.start : refused.end], refused.meant, otherwise=f"such as {_SUCH_AS[what]}")
        span = node.span.inside(text, refused.start, refused.end)
        return BAD_ICE_TEXT.at(span, what=what, text=text, problem=refused.problem, hint=meant)
    return None
