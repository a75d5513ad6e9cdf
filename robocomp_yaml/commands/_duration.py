"""Durations on a command line."""

from __future__ import annotations

from typing import Any

import click


class Duration(click.ParamType):  # type: ignore[type-arg]  # older ones are not generic
    """A duration with its unit, as in documents; in seconds."""

    name = "time"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        from robocomp_yaml.model.duration import duration

        seconds = value if isinstance(value, float) else duration(value)
        if not seconds:
            self.fail(f"'{value}' is not a duration, such as 30s or 2min", param, ctx)
        return seconds
