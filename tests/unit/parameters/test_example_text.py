"""Examples of texts with a pattern are ones that it matches."""

from __future__ import annotations

import pytest

from robocomp_yaml.parameters.patterns.example_text import example_text
from robocomp_yaml.parameters.patterns.pattern import parse


@pytest.mark.parametrize(
    ("pattern", "text"),
    [
        ("/dev/video[0-9]", "/dev/video0"),
        ("[a-z]+", "text"),
        (r"\d{1,3}(\.\d{1,3}){3}", "0.0.0.0"),
        ("(COM|tty)[1-9]|usb", "COM1"),
        (r"[^\w]x?.{2}\tz*", "-aa\t"),
        (r"\(\[\]\)\+[\]]", "([])+]"),
        ("[☃]|", "☃"),
        ("(|a)b", "b"),
        ("", ""),
    ],
)
def test_it_matches(pattern: str, text: str) -> None:
    assert example_text(parse(pattern)) == text
    assert parse(pattern).matches(text)
