"""What the explanations of IDSL's codes list is what the checks go by."""

from __future__ import annotations

import pytest

from robocomp_yaml.check.idsl.definitions import LARGEST
from robocomp_yaml.check.idsl.names import RESERVED, RESERVED_SUFFIXES, UNESCAPED_IN_PYTHON
from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import idsl
from robocomp_yaml.model.interface import BASIC_TYPES


@pytest.mark.parametrize(
    ("row", "words"),
    [
        (idsl.RESERVED_WORD, RESERVED),
        (idsl.PYTHON_WORD, UNESCAPED_IN_PYTHON | {"staticmethod"}),
        (idsl.ILLEGAL_NAME, RESERVED_SUFFIXES),
        (idsl.UNKNOWN_TYPE, BASIC_TYPES),
        (idsl.MISFIT, BASIC_TYPES),
        (idsl.ENUM_NUMBER, [str(LARGEST)]),
    ],
    ids=lambda part: part.id if isinstance(part, Code) else "",
)
def test_the_explanation_names_them_all(row: Code, words: list[str]) -> None:
    told = row.why.replace(",", " ").replace("(", " ").replace(")", " ").replace("`", " ").replace(".", " ").split()
    assert set(words) <= set(told)
