"""All judges of values give the same verdict, on values that fit and on values that do not."""

from __future__ import annotations

from typing import Any

import jsonschema_rs
from hypothesis import HealthCheck, Phase, example, given, settings
from hypothesis import strategies as st

from by_cerberus import cerberus_verdict
from parameters import Data, linked, values
from random_parameters import documents, mutated
from robocomp_yaml.parameters.defaults import with_defaults
from robocomp_yaml.parameters.json_schema import DOCUMENT, document_schema, fits
from robocomp_yaml.parameters.layers.completion import completed
from robocomp_yaml.parameters.layers.effective import effective
from verdicts import CASES, verdicts

RELAXED = settings(
    max_examples=CASES,
    deadline=None,
    suppress_health_check=list(HealthCheck),
    phases=[Phase.explicit, Phase.reuse, Phase.generate],  # a case is small as it is; shrinking one takes minutes
)
DEVICE = {"parameters": {"device": {"type": "string", "pattern": "a|b"}}}
WHOLE = {"parameters": {"n": {"type": "long", "default": 1}, "f": {"type": "float", "default": 1}}}


@st.composite
def judged(draw: st.DrawFn) -> tuple[Data, Any]:
    document, data = draw(documents())
    for _ in range(draw(st.integers(0, 2))):
        data = draw(mutated(data))
    return document, data


@given(judged())
@RELAXED
@example((DEVICE, {"device": "a\n"}))
@example((DEVICE, {"device": "xa"}))
@example((WHOLE, {"n": True}))
@example((WHOLE, {"n": 2.0}))
@example((WHOLE, {"n": 2.0**63}))
@example((WHOLE, {"f": 2**2000}))
@example((WHOLE, {"f": float("nan")}))
def test_all_judges_agree(case: tuple[Data, Any]) -> None:
    document, data = case
    parameters = linked(document).parameters
    if isinstance(data, dict):  # every component has its periods; a document need not give them
        found = verdicts(parameters, data)
        assert len(set(found.values())) == 1, found


@given(judged())
@RELAXED
@example((WHOLE, {"n": None}))
@example((WHOLE, {"n": 2.5}))
@example((WHOLE, {"x-n": 2}))
def test_editors_report_what_the_gate_of_documents_rejects(case: tuple[Data, Any]) -> None:
    """Their schema has another form, so that each value has one message."""
    document, data = case
    of = linked(document)
    schema = jsonschema_rs.Draft7Validator(document_schema(of.parameters, "C", {}, DOCUMENT))
    if isinstance(data, dict):
        assert schema.is_valid({"parameters": data}) == fits(of, DOCUMENT, data)


@given(documents())
@RELAXED
def test_what_fits_is_made_complete(case: tuple[Data, Data]) -> None:
    """Part by part or as a whole, by Cerberus or by hand: defaults are filled in alike."""
    document, data = case
    of = linked(document)
    found, faults = effective(values(of, data))
    assert found is not None, faults
    root = of.parameters.root
    assert found.data == completed(of, data) == cerberus_verdict(root, data)[1] == with_defaults(root, data)
