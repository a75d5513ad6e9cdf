"""Properties to values, as legacy files spell them: by the compiler's types and by those of generated Python."""

from __future__ import annotations

from typing import Any

import pytest

import accessors
from parameters import linked
from robocomp_yaml.parameters.defaults import with_defaults
from spellings import CASES, DOCUMENT

PARAMETERS = linked(DOCUMENT).parameters


@pytest.mark.parametrize(("properties", "expected"), CASES)
def test_types_of_the_compiler(properties: dict[str, str], expected: dict[str, Any] | None) -> None:
    read, problems = accessors.as_written(PARAMETERS, properties)
    assert bool(problems) == (expected is None), problems
    assert expected is None or read == with_defaults(PARAMETERS.root, {"spelled": expected})


@pytest.mark.parametrize(("properties", "expected"), CASES)
def test_types_of_generated_python(properties: dict[str, str], expected: dict[str, Any] | None) -> None:
    from_text, problems = accessors.read(PARAMETERS, properties)
    assert bool(problems) == (expected is None), problems
    assert expected is None or from_text == with_defaults(PARAMETERS.root, {"spelled": expected})
