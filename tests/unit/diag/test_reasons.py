"""The words of the operating system in messages."""

from __future__ import annotations

import pytest

from robocomp_yaml.diag.errors import reason_of


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (OSError(28, "No space left on device"), "no space left on device"),
        (OSError("PATH contains no program 'x'"), "PATH contains no program 'x'"),
        (OSError(1, ""), "[Errno 1] "),
    ],
)
def test_a_reason_begins_like_the_rest_of_a_message(error: OSError, words: str) -> None:
    assert reason_of(error) == words
