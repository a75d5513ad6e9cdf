"""What a component says of its state, as `status` and `top` show it."""

from __future__ import annotations

from robocomp_yaml.deploy.introspection import state_in
from robocomp_yaml.wire.introspection import STATE, Facts


def test_times_are_in_milliseconds() -> None:
    found = state_in({STATE: [Facts("x", {"state": "running"}, {"since": 17.32523136000009})]})
    assert found is not None and found.since == 17.325 and found.is_running


def test_without_that_section_it_is_unknown() -> None:
    assert state_in({}) is None
