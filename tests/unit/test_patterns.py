"""Regular expressions that are compiled at their first use."""

from __future__ import annotations

import re

import pytest

from robocomp_yaml.patterns import pattern


def test_results_are_those_of_re() -> None:
    made, plain = pattern(r"(?P<word>[a-z]+)-", re.IGNORECASE), re.compile(r"(?P<word>[a-z]+)-", re.IGNORECASE)
    assert made.fullmatch("Gripper-")["word"] == "Gripper"
    assert made.sub("", "a-B-c") == plain.sub("", "a-B-c") == "c"
    assert (made.pattern, made.flags, made.groupindex) == (plain.pattern, plain.flags, plain.groupindex)
    assert pattern(rb"#\s*").match(b"#  x").end() == 3


def test_nothing_is_compiled_before_the_first_use() -> None:
    wrong = pattern("(")
    with pytest.raises(re.error, match="unterminated"):
        wrong.search("(")
