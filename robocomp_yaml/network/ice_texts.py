"""What is wrong with proxies and endpoints that a deployment's document spells, and what it says instead."""

from __future__ import annotations

from msgspec.structs import replace

from robocomp_yaml.diag.fix import Hint
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.network.draft import Draft
from robocomp_yaml.source.ice_options import InvalidIceText

_ANY_TEXT = "what is for a program that is none of Ice, and may be any text, stands under `args:` or `env:`"


def place(draft: Draft, span: Span, text: str, refused: InvalidIceText) -> Span:
    """Where the fault is. The text of an instance is not as the document has it: `{i}` is filled in."""
    return span if draft.instance.number is not None else span.inside(text, refused.start, refused.end)


def hint(draft: Draft, text: str, refused: InvalidIceText, otherwise: str) -> Hint:
    said = did_you_mean(text[refused.start : refused.end], refused.meant, otherwise=otherwise)
    return said if draft.instance.component is not None else replace(said, text=f"{said}; {_ANY_TEXT}")
