"""Properties to values, as legacy files spell them: by our reader and by that of generated Python."""

from __future__ import annotations

from typing import Any

import pytest

import accessors
from parameters import linked
from robocomp_yaml.values.defaults import with_defaults
from robocomp_yaml.values.read import properties_to_values
from spellings import CASES, DOCUMENT

PARAMETERS = linked(DOCUMENT).parameters


@pytest.mark.parametrize(("properties", "expected"), CASES)
def test_our_reader(properties: dict[str, str], expected: dict[str, Any] | None) -> None:
    read, errors = properties_to_values(PARAMETERS, properties)
    assert bool(errors) == (expected is None), errors
    assert expected is None or read == with_defaults(PARAMETERS.root, {"spelled": expected})


@pytest.mark.parametrize(("properties", "expected"), CASES)
def test_the_reader_of_generated_python(properties: dict[str, str], expected: dict[str, Any] | None) -> None:
    from_text, problems = accessors.read(PARAMETERS, properties)
    assert bool(problems) == (expected is None), problems
    assert expected is None or from_text == with_defaults(PARAMETERS.root, {"spelled": expected})
