"""A key without a blank after its colon is reported where it is, whatever YAML makes of it."""

from __future__ import annotations

import pytest

from in_memory import analysed, said

A = "component: A\nlanguage: python\n"
I = "module: L\ninterfaces:\n  I:\n    methods:\n"  # noqa: E741 - an interface
V = "component: a.pdsl.yaml\nparameters:\n"


@pytest.mark.parametrize(
    ("name", "text", "key"),
    [
        ("a.cdsl.yaml", "component:A\n", "component:A"),
        ("a.cdsl.yaml", "component:A\nlanguage: python\n", "component:A"),
        ("a.cdsl.yaml", "component:A\nlanguage:python\n", "component:A"),
        ("a.cdsl.yaml", "component: A\nlanguage:python\nperiod: 5\n", "language:python"),
        ("a.cdsl.yaml", f"{A}period:5\n", "period:5"),
        ("a.cdsl.yaml", f"{A}# how often\nperiod:5 # often\n\n", "period:5"),
        ("l.idsl.yaml", f"{I}      go:{{in: {{a: int}}}}\n      stop:\n", "go:{in: {a: int}}"),
        ("l.idsl.yaml", f"{I}      go:\n        in:\n          a:int\n          b: int\n", "a:int"),
        ("l.idsl.yaml", f"{I}      go:\n        in:\n          b: int\n          a:int\n", "a:int"),
        ("a.pdsl.yaml", "parameters:\n  speed:float\n  x: int\n", "speed:float"),
        ("a.pdsl.yaml", "parameters:\n  speed:float\n", "speed:float"),
        ("a.pdsl.yaml", "parameters:\n  n: int\nconstraints:\n  - that:n > 1\n    else: no\n", "that:n > 1"),
    ],
)
def test_the_key_is_named(name: str, text: str, key: str) -> None:
    (one,) = said({name: text})
    assert (one.code, one.at, one.hint) == ("RC0108", key, f"write '{key.replace(':', ': ', 1)}'")


@pytest.mark.parametrize(
    ("name", "text", "codes"),
    [
        ("a.cdsl.yaml", f"{A}doc: one\n  see:this\n  and: that\n", ["RC0101"]),
        ("a.cdsl.yaml", f"{A}doc: http://x.org\n", []),
        ("a.cdsl.yaml", f"{A}doc:\n  http://x.org\n  and: that\n", ["RC0101"]),
        ("a.cdsl.yaml", f"{A}doc: {{x: 1}}\n", ["RC0204"]),
        ("a.cdsl.yaml", f"{A}doc:\n  - localhost:10000\n    x: 1\n", ["RC0101"]),
        ("a.cdsl.yaml", f'{A}parameters: "a:b"\n', ["RC3202"]),
        ("a.cdsl.yaml", "just text\n", ["RC0201"]),
    ],
)
def test_a_text_with_a_colon_is_no_such_key(name: str, text: str, codes: list[str]) -> None:
    assert [one.code for one in said({name: text})] == codes


def test_the_fix_inserts_the_blank() -> None:
    (one,) = analysed({"a.cdsl.yaml": "component: A\nlanguage:python\nperiod: 5\n"}).diagnostics
    ((edit,),) = [fix.edits for fix in one.fixes]
    assert (edit.span.line, edit.span.column, edit.span.end_column, edit.text) == (2, 10, 10, " ")
