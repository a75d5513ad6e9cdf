"""Diagnostics of a text, moved to where their lines are after an edit."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from msgspec.structs import replace

from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span


def moved(found: Iterable[Diagnostic], path: str, before: Sequence[str], after: Sequence[str]) -> Iterator[Diagnostic]:
    """The diagnostics of a document in lines that an edit did not change. `before` and `after` are the lines of the
    document. Fixes are dropped if they edit the document below the change: their texts are those of before."""
    most = min(len(before), len(after))
    head = next((at for at in range(most) if before[at] != after[at]), most)
    most -= head
    tail = next((at for at in range(most) if before[-1 - at] != after[-1 - at]), most)
    first, shift = len(before) - tail, len(after) - len(before)

    def at(span: Span) -> Span:
        if span.file != path or span.line <= first or not shift:
            return span
        return replace(span, line=span.line + shift, end_line=span.end_line + shift)

    for one in found:
        span = one.span
        if span.file != path or (span.line <= head and span.end_line <= head + 1) or span.line > first:
            related = tuple(replace(each, span=at(each.span)) for each in one.related)
            fixes = tuple(fix for fix in one.fixes if all(at(edit.span) == edit.span for edit in fix.edits))
            yield replace(one, span=at(span), related=related, fixes=fixes)
