"""Constraints as C++."""

from __future__ import annotations

import re

from robocomp_yaml.emit.lowering.constraints import Calls
from robocomp_yaml.languages.cpp import LANGUAGE
from robocomp_yaml.languages.cpp.text import literal, value
from robocomp_yaml.parameters.specification.expression import Expression
from robocomp_yaml.parameters.types import RecordType

VALUE = "const runtime::Value&"
_TAKEN = frozenset(("p", "of", "runtime", "std"))


def lambda_of(expression: Expression, root: RecordType) -> str:
    """A lambda with the parameters' values as its argument `p`."""
    return _function("p", _CALLS.of(expression, root), capture="")


def _function(variable: str, body: str, capture: str = "&") -> str:
    used = re.search(rf"\b{variable}\b", body)
    return f"[{capture}]({VALUE}{f' {variable}' if used else ''}) {{ return {body}; }}"


def _variable(name: str, depth: int) -> str:
    return f"{name}_" if name in _TAKEN else LANGUAGE.in_code(name)


_CALLS = Calls(
    prefix="of::",
    value=value,
    text=literal,
    sign=lambda sign: f"'{sign}'",
    listing=lambda items: f"runtime::Value(runtime::Value::List{{{', '.join(items)}}})",
    pairs=lambda pairs: f"{{{', '.join(f'{{{sign}, {part}}}' for sign, part in pairs)}}}",
    later=lambda code: f"[&] {{ return {code}; }}",
    parts=lambda parts: f"{{{', '.join(parts)}}}",
    function=_function,
    member=lambda owner, key: f"{owner}[{key}]",
    variable=_variable,
)
