"""Names with {i}, the number of an instance, are reported as they are written, once, and fixed there."""

from __future__ import annotations

import pytest

from in_memory import analysed, said

MOUTHS = 'deployment: D\ncomponents:\n  "mouth{i}": {program: sleep, instances: 2}\n'


@pytest.mark.parametrize("others", ["", ", mouth0"])
def test_a_typing_error_is_reported_once_and_fixed(others: str) -> None:
    text = f'{MOUTHS}  "speech{{i}}": {{program: sleep, instances: 2, after: ["muoth{{i}}"{others}]}}\n'
    (one,) = said({"d.ddsl.yaml": text})
    assert (one.code, one.at, one.hint) == ("RC4005", '"muoth{i}"', "did you mean 'mouth{i}'?")
    (found,) = analysed({"d.ddsl.yaml": text}).diagnostics
    ((edit,),) = [fix.edits for fix in found.fixes]
    assert edit.text == "mouth{i}"


def test_a_number_that_another_entry_lacks_is_named() -> None:
    text = f'{MOUTHS}  "speech{{i}}": {{program: sleep, instances: 3, after: ["mouth{{i}}"]}}\n'
    (one,) = said({"d.ddsl.yaml": text})
    assert (one.code, one.message) == ("RC4005", "`after:` names 'mouth2', which is unknown")


def test_only_instances_have_a_number() -> None:
    (one,) = said({"d.ddsl.yaml": f'{MOUTHS}  speech: {{program: sleep, after: ["muoth{{i}}"]}}\n'})
    assert one.hint == "only an entry with `instances:` replaces {i}"
