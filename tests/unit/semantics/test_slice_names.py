"""Names of Slice that Python cannot have."""

from __future__ import annotations

import keyword

from robocomp_yaml.languages.python.names import ICE_ESCAPES
from robocomp_yaml.semantics.slice_names import NOT_ESCAPED


def test_ice_escapes_a_keyword_or_we_do() -> None:
    assert {*keyword.kwlist, "staticmethod"} - ICE_ESCAPES == set(NOT_ESCAPED)
