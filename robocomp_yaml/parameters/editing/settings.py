"""The values of a configuration with their origin, as they are shown."""

from __future__ import annotations

from typing import Any

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.semantics import connections

DEFAULT, DERIVED, SET = "default", "derived", "set"


class OverriddenValue(msgspec.Struct, frozen=True):
    """A value that another one replaces, and its location."""

    value: str
    span: Span


class ShownSetting(msgspec.Struct, frozen=True):
    """One value of a configuration, without secrets. `key` is the path of a parameter, or the name of a
    property. `source` is SET (in the document of `span`), DERIVED (from the deployment), or DEFAULT. `overrode` are the
    replaced values, the latest first. `is_outside`: the proxy of a server that no process of the deployment is.
    `is_notable`: it is derived and replaces what the user chose, or leads outside. `data` is the value of a parameter,
    None for others."""

    key: str
    value: str
    source: str
    span: Span | None = None
    overrode: tuple[OverriddenValue, ...] = ()
    is_outside: bool = False
    is_notable: bool = False
    data: Any = None


def run_time_defaults() -> list[ShownSetting]:
    """What the run time of every component sets, unless its configuration does."""
    return [ShownSetting(key, value, DEFAULT) for key, value in connections.ICE_DEFAULTS.items()]
