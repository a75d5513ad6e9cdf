"""Which events a descriptor matches, and delays."""

from __future__ import annotations

import pytest

from robocomp_yaml.semantics.events import beginning, matches, seconds


@pytest.mark.parametrize(
    ("descriptor", "event", "is_one"),
    [
        ("door", "door", True),
        ("door", "door.open", True),
        ("door", "doors", False),
        ("door.*", "door.open", True),
        ("door.", "door", True),
        ("door.open", "door", False),
        ("*", "anything.at.all", True),
        ("error.*", "error", True),
    ],
)
def test_descriptors_of_events(descriptor: str, event: str, is_one: bool) -> None:
    assert matches(["other", descriptor], event) == is_one


@pytest.mark.parametrize("descriptor", ["*", ".*", "*.", "*.*", ""])
def test_what_matches_everything(descriptor: str) -> None:
    assert beginning(descriptor) == ""


@pytest.mark.parametrize(
    ("delay", "found"),
    [
        ("1.5s", 1.5),
        ("100ms", 0.1),
        (" +.5 s ", 0.5),
        ("1.s", 1.0),
        ("0s", 0.0),
        ("-1s", None),
        ("1", None),
        ("1 min", None),
    ],
)
def test_delays(delay: str, found: float | None) -> None:
    assert seconds(delay) == found
