"""Who judges values. A judge is a function (parameters, data) -> verdict. Generated C++ judges many values at once, so
its test asks all these for theirs, too.

RCYAML_CASES=5000 RCYAML_CPP_DOCUMENTS=500 make a run a long one.
"""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Callable
from typing import Any

import jsonschema
import jsonschema_rs

import accessors
from by_cerberus import cerberus_verdict
from parameters import tree
from robocomp_yaml.parameters.json_schema import EFFECTIVE, document_schema, values_schema
from robocomp_yaml.parameters.types import Parameters
from robocomp_yaml.parameters.verdict.judge import judge
from robocomp_yaml.source.yaml_text import flow

Judge = Callable[[Parameters, Any], bool]
CASES = int(os.environ.get("RCYAML_CASES", "200"))
CPP_DOCUMENTS = int(os.environ.get("RCYAML_CPP_DOCUMENTS", "12"))
_LAST: list[Any] = []  # the parameters that were asked for last, and the validators of their schema


def ours(parameters: Parameters, data: Any) -> bool:
    return not list(judge(parameters.root, tree(flow(data)), (), complete=True))


def by_cerberus(parameters: Parameters, data: Any) -> bool:
    return cerberus_verdict(parameters.root, data)[0]


def by_jsonschema_rs(parameters: Parameters, data: Any) -> bool:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about numbers that are larger than any limit
        return _validators(parameters)[0].is_valid(data)


def by_jsonschema(parameters: Parameters, data: Any) -> bool:
    return _validators(parameters)[1].is_valid({"parameters": _as_json(data)})


def _validators(parameters: Parameters) -> tuple[Any, Any]:
    if not _LAST or _LAST[0] is not parameters:
        gate, written = values_schema(parameters, EFFECTIVE), document_schema(parameters, "C", {}, EFFECTIVE)
        _LAST[:] = [parameters, jsonschema_rs.Draft7Validator(gate), jsonschema.Draft7Validator(written)]
    return _LAST[1], _LAST[2]


def by_python_accessors(parameters: Parameters, data: Any) -> bool:
    return not accessors.take(parameters, data)[1]


def _as_json(data: Any) -> Any:
    """JSON has no NaN and no infinities: what reads such a document as JSON sees null."""
    if isinstance(data, dict):
        return {key: _as_json(value) for key, value in data.items()}
    if isinstance(data, list):
        return [_as_json(item) for item in data]
    return None if isinstance(data, float) and not math.isfinite(data) else data


JUDGES: dict[str, Judge] = {
    "ours": ours,
    "Cerberus": by_cerberus,
    "jsonschema-rs": by_jsonschema_rs,
    "jsonschema": by_jsonschema,
    "generated Python": by_python_accessors,
}


def verdicts(parameters: Parameters, data: Any) -> dict[str, bool]:
    return {name: judge(parameters, data) for name, judge in JUDGES.items()}
