"""Where values come from, and what they override, as text and as JSON."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from robocomp_yaml.diag.span import Span
from robocomp_yaml.parameters.editing.settings import DERIVED, SET, ShownSetting

_LONG = 40


def origin(one: ShownSetting) -> str:
    """The source of a value, and what it overrides."""
    where = _location(one.span) if one.source == SET else ", ".join([one.source, *filter(None, [_location(one.span)])])
    overrode = "".join(f", overrides {_cut(old.value)} ({_location(old.span)})" for old in one.overrode)
    outside = "; outside of the deployment" if one.is_outside else ""
    return f"{where}{overrode}{outside}"


def settings_data(settings: Iterable[ShownSetting]) -> list[dict[str, Any]]:
    return [
        {
            "property": one.key, "value": one.value, "source": one.source, **_place(one.span),
            "overrode": [{"value": old.value, **_place(old.span)} for old in one.overrode], "outside": one.is_outside,
        }
        for one in settings
    ]  # fmt: skip


def is_worth_a_line(one: ShownSetting) -> bool:
    """Whether a plan shows a value without being asked: it is derived and replaces what the user chose, or leads
    outside."""
    return one.is_notable or (one.is_outside and one.source != DERIVED)


def _location(span: Span | None) -> str:
    return f"{span.file}:{span.line}" if span is not None else ""


def _place(span: Span | None) -> dict[str, Any]:
    return {"file": span.file if span else None, "line": span.line if span else None}


def _cut(text: str) -> str:
    return text if len(text) <= _LONG else f"{text[: _LONG - 1]}…"
