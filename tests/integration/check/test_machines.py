"""Diagnostics of state machines: each fault is reported once, at its location, and right machines have none."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest

HEAD = '<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" {}>\n'
Check = Callable[..., list[dict[str, Any]]]


def said(diagnostics: Check, scxml: str, language: str = "python") -> list[str]:
    files = {"c/c.cdsl.yaml": f"component: C\nlanguage: {language}\nstatemachine: c.scxml\n", "c/c.scxml": scxml}
    return [f"{d['line']}:{d['column']} {d['code']} {d['message']}" for d in diagnostics(files)]


def inline(diagnostics: Check, text: str) -> list[str]:
    files = {"c/c.cdsl.yaml": f"component: C\nlanguage: cpp\nstatemachine:\n{text}"}
    return [f"{d['line']}:{d['column']} {d['code']} {d['message']} {d['hint']}".strip() for d in diagnostics(files)]


def machine(inner: str, attributes: str = 'initial="a"') -> str:
    return HEAD.format(attributes) + inner + "\n</scxml>\n"


A_B = '<state id="a"><transition event="go" target="b"/></state><state id="b"/>'


@pytest.mark.parametrize(("scxml", "messages"), [
    (machine(A_B), []),
    (machine(A_B, 'initial="b"'), ["2:12 RC2227 unreachable state 'a'"]),
    (machine(A_B, 'initial="c"'), ["1:71 RC2221 unknown state 'c'"]),
    (machine('<state id="a"><transition event="done.state.a" target="b"/></state><final id="b"/>'),
     ["2:34 RC2229 nobody sends the event 'done.state.a': 'a' has no final state in it"]),
    (machine('<state id="a"><transition event="done.invoke.x error.* * .*"/></state>'),
     ["2:34 RC2229 nobody sends the event 'done.invoke.x': no invocation has this id"]),
    (machine('<state id="a"><transition event="go" target="b c"/></state>'
             '<parallel id="p"><state id="b"/><state id="c"/></parallel>'), []),
    (machine('<state id="a"><transition event="go" target="p b"/></state>'
             '<parallel id="p"><state id="b"/></parallel>'),
     ["2:48 RC2226 'p' and 'b' cannot be active together"]),
    (machine('<state id="a"><transition cond="x" target="a"/><transition target="a"/></state>'), []),
    (machine('<state id="a" initial="b"><transition target="a"/><state id="b"/></state>'),
     ["2:27 RC2233 endless circle of transitions: a → a"]),
    (machine('<state id="a"><transition event="go" target="d"/></state><state id="b" initial="c">'
             '<state id="c"/><state id="d"><transition event="back" target="b"/></state></state>'), []),
    (machine('<state id="a"><transition event="go" target="d"/></state><state id="b" initial="c">'
             '<state id="c"/><state id="d"/></state>'), ["2:95 RC2227 unreachable state 'c'"]),
    (machine('<state id="a" initial="b"><state id="b"><transition event="x" target="e"/></state>'
             '<history id="h"><transition target="b"/></history></state>'
             '<state id="e"><transition event="y" target="h"/></state>'), []),
    (machine('<state id="ä"/>', 'initial="ä"'), ["2:12 RC2222 'ä' cannot be the name of a state"]),
    (machine('<state id="a"><onentry><script>while True: pass</script></onentry></state>'),
     ["2:24 RC2217 the script 'while True: pass' is not valid in the data model null: 'while True: pass' is not the name of "
      "an action"]),
    (machine('<state id="a"><transition cond="In(\'z\')" event="x"/></state>'), ["2:33 RC2221 unknown state 'z'"]),
    (machine('<state id="a"><onentry><foreach array="x" item="y"/><assign location="z" expr="1"/></onentry></state>'),
     ["2:40 RC2218 <foreach> needs a data model with variables",
      "2:71 RC2218 <assign> needs a data model with variables"]),
    (machine('<state id="a"><transition event="x" cond="class"/></state>'),
     ["2:43 RC2237 'class' cannot be the name of a guard or of an action"]),
    (machine('<state id="a"><transition event="x" cond="sm_a"/></state>'),
     ["2:43 RC2231 the state 'a' and the guard 'sm_a' have the same name 'sm_a' in code"]),
    (machine('<state id="a"><transition event="x" cond="y"><script>y</script></transition></state>'),
     ["2:46 RC2231 the guard 'y' and the action 'y' have the same name 'y' in code"]),
    (machine('<state id="a"><transition event="a.b a_b"/></state>'),
     ["2:38 RC2231 the event 'a.b' and the event 'a_b' have the same name 'a_b' in code"]),
    (machine('<state id="a"><transition event="x"/></state>',
             'initial="a" xmlns:rc="urn:robocomp:statemachine" rc:events="y"'),
     ["2:34 RC2229 nobody sends the event 'x'"]),
    (machine('<state id="a"><invoke><content><scxml initial="z"><state id="y"/></scxml></content></invoke></state>'),
     ["2:48 RC2221 unknown state 'z'"]),
    (machine('<state id="a"><invoke src="../x.scxml"/></state>'),
     ["2:28 RC2215 '../x.scxml' cannot be included: it is not below the document's folder"]),
    (machine('<state id="a"><invoke src="http://127.0.0.1/x.scxml"/></state>'),
     ["2:28 RC2215 'http://127.0.0.1/x.scxml' cannot be included: only files can be included"]),
    (machine('<state id="a"><invoke src="c.scxml"/></state>'),
     ["2:28 RC2215 'c.scxml' cannot be included: it includes itself"]),
    (machine('<state id="a"><invoke src="d.scxml"/></state>'),
     ["2:28 RC2215 'd.scxml' cannot be included: the file does not exist"]),
    (machine('<state id="a"><onentry><send event="x" delay="1"/></onentry><transition event="x"/></state>'),
     ["2:47 RC2211 '1' is not a value of 'delay'"]),
    (machine('<state id="a"><transition event="x" target="b"/><transition event="y x" target="a"/></state>'
             '<state id="b"/>'),
     ["2:70 RC2238 this transition of 'a' is never taken for 'x': an earlier one takes 'x'"]),
    (machine('<state id="a"><transition cond="x" event="e" target="b"/><transition event="e" target="a"/></state>'
             '<state id="b"><transition event="a.b" target="a"/><transition event="a" target="a"/></state>'), []),
    (machine('<state id="a"/>', 'initial="a" xmlns:rc="urn:robocomp:statemachine" rc:events="x y x"'),
     ["1:126 RC2239 the event 'x' is listed twice"]),
    (machine('<state id="a" initial="b"><state id="b"/><history id="h"><transition event="x" target="b"/></history>'
             '<transition event="y" target="h"/></state>'),
     ["2:77 RC2241 the transition of the history 'h' cannot have an event or a condition"]),
    (machine('<state id="a"/>', 'initial="a" datamodel="python"').replace("<state", "<script>import os\n</script><state"),
     []),
    ("\ufeff" + machine(A_B), []),
    ("", ["1:1 RC2202 this is not well-formed XML: no element found"]),
    ("<scxml>", ["1:8 RC2202 this is not well-formed XML: no element found"]),
], ids=lambda value: repr(value)[75:140] if isinstance(value, str) else "")  # fmt: skip
def test_files(diagnostics: Check, scxml: str, messages: list[str]) -> None:
    assert said(diagnostics, scxml) == messages


def test_guards_and_methods_of_interfaces_share_a_class(diagnostics: Check) -> None:
    files = {
        "c/c.cdsl.yaml": "component: C\nlanguage: cpp\nimports: [A]\nrequires: [A]\nimplements: [A]\n"
        "statemachine: {initial: a, transitions: {a: {to: a, if: A_f or a_proxy}}}\n",
        "c/A.idsl.yaml": "module: M\ninterfaces: {A: {methods: {f: }}}\n",
    }
    assert [(d["code"], d["message"]) for d in diagnostics(files)] == [
        ("RC2231", "the method 'A_f' and the guard 'A_f' have the same name 'A_f' in code"),
        ("RC2231", "the proxy 'A' and the guard 'a_proxy' have the same name 'a_proxy' in code"),
    ]


@pytest.mark.parametrize(("keys", "codes"), [("", []), ("compatibility: robocomp\n", ["RC2237"])], ids=["", "robocomp"])
def test_names_of_robocomps_worker(diagnostics: Check, keys: str, codes: list[str]) -> None:
    machine = "statemachine: {initial: a, transitions: {a: {to: a, event: x, if: timer}}}\n"
    files = {"c.cdsl.yaml": f"component: C\nlanguage: cpp\n{keys}{machine}"}
    assert [d["code"] for d in diagnostics(files)] == codes


def test_no_script_language_in_cpp(diagnostics: Check) -> None:
    text = machine('<state id="a"/>', 'initial="a" datamodel="python"')
    assert said(diagnostics, text, "cpp") == ["1:85 RC2216 the data model 'python' is not available in C++"]


@pytest.mark.parametrize(("text", "messages"), [
    ("  initial: a\n", []),
    ("  initial: a\n  transitions: {a: [{event: go, do: beep}, {event: x, if: y}]}\n", []),
    ("  initial: a\n  transitions: {a: b}\n", ["5:20 RC2221 unknown state 'b' add it under `states:`"]),
    ("  initial: a\n  transitions: {b: a}\n", ["5:17 RC2221 unknown state 'b' add it under `states:`"]),
    ("  initial: a\n  transitions: {a: {do: b}}\n",
     ["5:20 RC2233 endless circle of transitions: a → a give one of the transitions an event or a condition"]),
    ("  initial: a\n  states: {b: {states: {c: {}}}}\n  transitions: {a: b}\n",
     ["5:12 RC2223 the state 'b' has no initial state write initial: c"]),
    ("  initial: a\n  states: {b: {parallel: true, states: {c: {}}}}\n  transitions: {a: b}\n", []),
    ("  initial: a\n  states: {b: {initial: c, states: {c: {}, d: {}, h: {history: deep}}}}\n"
     "  transitions: {a: b, c: d, b: {to: h, event: again}}\n",
     ["5:51 RC2223 the history 'h' has no initial state write transitions: {h: …}, for the first time, "
      "when it remembers nothing"]),
    ("  initial: a\n  transitions: {a: {to: a, event: x y.z w.*, if: 'In(\"a\")'}}\n", []),
    ("  initial: a\n  transitions: {a: {to: a, if: '1 < 2'}}\n",
     ["5:32 RC2217 the condition '1 < 2' is not valid in the data model null: '1 < 2' is neither the name of a guard nor In('state')"]),
], ids=lambda value: repr(value)[:60] if isinstance(value, str) else "")  # fmt: skip
def test_inline(diagnostics: Check, text: str, messages: list[str]) -> None:
    assert inline(diagnostics, text) == messages


@pytest.mark.parametrize(("text", "messages"), [
    ("  initial: runing\n  states: {running: {}, idle: {}}\n  transitions: {running: idle, idle: running}\n",
     ["4:12 RC2221 unknown state 'runing' did you mean 'running'?"]),
    ("  initial: idle\n  final: stopd\n  states: {stopped: {}, idle: {}}\n  transitions: {idle: stopped}\n",
     ["5:10 RC2221 unknown state 'stopd' did you mean 'stopped'?"]),
    ("  initial: initialize\n  final: finalize\n  states: {compute: {}}\n"
     "  transitions: {initialize: compute, compute: finalize}\n", []),
    ("  initial: a\n  final: b\n  transitions: {a: b}\n", []),
    ("  initial: off\n  states: {on: {initial: slow, states: {}}}\n  transitions: {off: on}\n", []),
    ("  initial: off\n  states: {on: {initial: slwo, final: qiuck, states: {slow: {}, quick: {}}}}\n"
     "  transitions: {off: on, slow: quick}\n",
     ["5:26 RC2221 unknown state 'slwo' did you mean 'slow'?",
      "5:39 RC2221 unknown state 'qiuck' did you mean 'quick'?"]),
    ("  initial: off\n  states: {on: {initial: no, states: {slow: {}}}}\n  transitions: {off: on, slow: on}\n",
     ["5:26 RC2221 unknown state 'no' add it under `states:`, or name a state that is listed there"]),
    ("  initial: off\n  states: {on: {initial: start, states: {slow: {}}}}\n  transitions: {off: on, start: slow}\n", []),
    ("  initial: off\n  states: {on: {initial: of, states: {slow: {}}}}\n  transitions: {off: on, slow: on}\n",
     ["5:26 RC2221 unknown state 'of' add it under `states:`, or name a state that is listed there"]),
    ("  initial: slow\n  states: {on: {initial: slow, states: {slow: {}}}}\n  transitions: {slow: on}\n", []),
    ("  initial: off\n  final: slow\n  states: {on: {initial: slow, states: {slow: {}}}}\n  transitions: {off: on}\n",
     ["5:10 RC2225 'slow' is not inside of the machine"]),
    ("  initial: p\n  states: {p: {parallel: true, states: {l: {initial: l1, states: {l2: {}}}, r: {}}}}\n"
     "  transitions: {p: l2}\n", ["5:54 RC2221 unknown state 'l1' add it under `states:`, or name a state that is listed there"]),
], ids=lambda value: repr(value)[:60] if isinstance(value, str) else "")  # fmt: skip
def test_an_unknown_state_in_initial_or_final(diagnostics: Check, text: str, messages: list[str]) -> None:
    assert inline(diagnostics, text) == messages


@pytest.mark.parametrize(("transitions", "reported"), [
    ("{a: [{to: b, event: x}, {to: c, event: @x}]}", "never for 'x': takes 'x'"),
    ("{a: [{to: b, event: x}, {to: c, event: @x, if: near}]}", "never for 'x': takes 'x'"),
    ("{a: [{to: b, event: x, if: near}, {to: c, event: x}]}", ""),
    ("{a: [{to: b, event: x, if: near}, {to: c, event: x, if: far}]}", ""),
    ("{a: [{to: b, event: x, if: near}, {to: c, event: @x, if: near}]}", "never for 'x': takes 'x' under the same"),
    ("{a: [{to: b, event: x y}, {to: c, event: z @y}]}", "never for 'y': takes 'y'"),
    ("{a: [{to: b, event: '*'}, {to: c, event: @x.y}]}", "never for 'x.y': takes '*'"),
    ("{a: [{to: b, event: x}, {to: c, event: @x.y.*}]}", "never for 'x.y.*': takes 'x'"),
    ("{a: [{to: b, event: x.y}, {to: c, event: x}]}", ""),
    ("{a: [{to: b, event: x}, {to: c, event: xy}]}", ""),
    ("{a: [{event: x, do: beep}, {to: c, event: @x}]}", "never for 'x': takes 'x'"),
    ("{a: [b, c, @b]}", "never for 't_a_to_b': takes 't_a_to_b'"),
    ("{a: [{to: b, if: near}, @{to: c, if: near}]}", "never: is taken at once under the same"),
    ("{a: [{to: b, if: near}, {to: c, event: @x, if: near}]}", "never for 'x': is taken at once under the same"),
    ("{a: {to: b, event: x}, b: {to: c, event: x}}", ""),
    ("{a: [{to: b, event: x, if: 'true'}, {to: c, event: @x}]}", "never for 'x': takes 'x'"),
    ("{a: [{to: b, event: x, if: far or not false}, {to: c, event: @x}]}", "never for 'x': takes 'x'"),
    ("{a: [{to: b, event: x, if: far and true}, {to: c, event: x}]}", ""),
    ("{a: [{to: b, event: x, if: 'false'}, {to: c, event: x}]}", ""),
    ("{a: [{to: b, event: x, if: not near}, {to: c, event: @x, if: '!near()'}]}", "never for 'x': takes 'x' under the same"),
    ("{a: [{to: b, event: @x}, {to: c, if: 'true'}]}", "never for 'x': is taken at once"),
    ("{a: [{to: b, event: x}, {to: c, if: near}]}", ""),
])  # fmt: skip
def test_transitions_that_are_never_taken(diagnostics: Check, transitions: str, reported: str) -> None:
    text = "component: C\nlanguage: cpp\nstatemachine:\n  initial: a\n  states:\n    {b: {}, c: {}}\n"
    line = f"  transitions: {transitions}"  # with an @ before the reported event
    found = diagnostics({"c.cdsl.yaml": f"{text}{line.replace('@', '')}\n"})
    errors = [d for d in found if d["severity"] == "error"]
    said = [
        re.sub(r".* is (never) taken(.*): (?:an earlier|a later) one(.*)", r"\1\2:\3", d["message"]) for d in errors
    ]
    assert len(said) == bool(reported) and "".join(said).startswith(reported)
    assert [(d["code"], d["line"], d["column"]) for d in errors] == (
        [("RC2238", 7, line.index("@") + 1)] if reported else []
    )


@pytest.mark.parametrize(("transitions", "severity"), [
    ('<transition event="x" target="b"/><transition event="x" target="a"/>', "error"),
    ('<transition event="x" target="b"/><transition event="x" target="b"><script>beep</script></transition>', "error"),
    ('<transition event="x"><script>beep</script></transition><transition event="x" cond="near" target="b"/>', "error"),
    ('<transition event="x" cond="true" target="b"/><transition event="x.*" target="a"/>', "error"),
    ('<transition event="y x" target="b"/><transition event="x z" target="a"/>', "error"),
    ('<transition target="b"/><transition target="c"/>', "error"),
    ('<transition event="x" target="b"/><transition event="x"  target="b"></transition>', "warning"),  # as W3C's 343
    ('<transition event="x" cond="near" target="b"/><transition event="x" cond="near" target="a"/>', "warning"),
    ('<transition event="*" target="b"/><transition event="x" target="a"/>', "warning"),
    ('<transition event="x" target="b"/><transition event="x.y" target="a"/>', "warning"),
    ('<transition event="x" target="b"/><transition target="c"/>', "warning"),  # as W3C's 419
    ('<transition event="*" target="b"/><transition target="c"/>', "warning"),
])  # fmt: skip
def test_lost_transitions_in_an_scxml_file(diagnostics: Check, transitions: str, severity: str) -> None:
    text = machine(f'<state id="a">{transitions}</state><state id="b"/><state id="c"/>')
    files = {"c.cdsl.yaml": "component: C\nlanguage: python\nstatemachine: c.scxml\n", "c.scxml": text}
    found = diagnostics(files)
    assert [(d["severity"], d["line"]) for d in found if d["code"] == "RC2238"] == [(severity, 2)]


def test_a_misspelled_initial_without_listed_states(diagnostics: Check) -> None:
    text = "  initial: clozed\n  final: gone\n  transitions: {closed: gone}\n"
    assert inline(diagnostics, text) == ["4:12 RC2221 unknown state 'clozed' did you mean 'closed'?"]


def test_a_hint_names_the_list_of_events(diagnostics: Check) -> None:
    rc = 'initial="a" xmlns:rc="urn:robocomp:statemachine" rc:events="stop"'
    files = {"c.cdsl.yaml": "component: C\nlanguage: python\nstatemachine: c.scxml\n"}
    [found] = diagnostics({**files, "c.scxml": machine('<state id="a"><transition event="door"/></state>', rc)})
    assert found["hint"].startswith("list it under `rc:events`")


def test_a_circle_of_conditions_that_are_always_true(diagnostics: Check) -> None:
    text = "  initial: a\n  states: {b: {}}\n  transitions: {a: {to: b, if: 'true'}, b: {to: a, if: not false}}\n"
    assert [said.split()[1] for said in inline(diagnostics, text)] == ["RC2233"]


def test_transitions_of_inner_states_are_separate(diagnostics: Check) -> None:
    """A child's transition comes before its parent's for the same event, in any order."""
    assert (
        inline(
            diagnostics,
            "  initial: a\n  states:\n    a: {initial: b, states: {b: {}, c: {}}}\n"
            "  transitions: {a: {to: a, event: x}, b: {to: c, event: x}}\n",
        )
        == []
    )


def test_a_state_with_transitions_at_two_levels(diagnostics: Check) -> None:
    text = (
        "  initial: a\n  transitions: {b: {to: a, event: x}}\n  states:\n"
        "    a: {initial: b, states: {b: {}}, transitions: {b: {to: b, event: x}}}\n"
    )
    assert [said[:12] for said in inline(diagnostics, text)] == ["7:70 RC2238 "]


def test_a_component_with_a_wrong_machine_is_not_compiled(rcyaml: Callable[..., Any], diagnostics: Check) -> None:
    assert said(diagnostics, machine(A_B.replace('target="b"', 'target="c"'))) != []
    result = rcyaml("compile", ".")
    assert result.exit_code == 1
    assert "wrote" not in result.output


def test_a_large_machine_is_checked_fast(diagnostics: Check) -> None:
    states = "".join(f'<state id="s{n}"><transition event="e{n}" target="s{n + 1}"/></state>' for n in range(3000))
    assert said(diagnostics, machine(states + '<state id="s3000"/>', 'initial="s0"')) == []
