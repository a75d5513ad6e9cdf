"""What methods of interfaces return in Python, and whether the generated code can call them: certain faults, and no
others. Ice 3.7 decides which values it can send; a wrong result makes a component in Python crash."""

from __future__ import annotations

import textwrap

import pytest

from judged_code import MACHINE, Link, component, found

VOICE = """\
module: RoboCompVoice
types:
  Tone: {enum: [high, low]}
  Sound: {struct: {pitch: float, tone: Tone}}
  Sounds: {sequence: Sound}
  Words: {sequence: string}
  Bytes: {sequence: byte}
  Counts: {map: {key: string, value: int}}
exceptions:
  Hoarse: {struct: {why: string}}
interfaces:
  Voice:
    methods:
      say: {in: {text: string}}
      length: {returns: int}
      small: {returns: byte}
      loud: {returns: float}
      name: {returns: string}
      isOn: {returns: bool}
      tone: {returns: Tone}
      sound: {returns: Sound}
      sounds: {returns: Sounds}
      words: {returns: Words}
      raw: {returns: Bytes}
      counts: {returns: Counts}
      both: {returns: Sound, out: {age: int}}
"""
HEAD = (
    "from generated.genericworker import GenericWorker\nfrom generated.interfaces import RoboCompMouth, RoboCompVoice\n"
)
NAMES = "from elsewhere import decorated, other\n\n\nclass SpecificWorker(GenericWorker):\n"
WHOLE = {"x.cdsl.yaml": "component: X\nlanguage: {}\nimports: [Mouth, Voice]\nimplements: [Voice]\nrequires: [Mouth]\n"}


def voice(language: str, more: str = "") -> dict[str, str]:
    cdsl = WHOLE["x.cdsl.yaml"].format(language) + more
    return {**component(language), "Voice.idsl.yaml": VOICE, "x.cdsl.yaml": cdsl}


def method(name: str, body: str, head: str = "def Voice_{}(self):") -> dict[str, str]:
    text = f"{head.format(name)}\n{textwrap.indent(body, '    ')}\n"
    return {"specificworker.py": HEAD + NAMES + textwrap.indent(text, "    ")}


@pytest.mark.parametrize(
    ("name", "value", "at"),
    [
        ("length", "'x'", "'x'"),
        ("length", "1.5", "1.5"),
        ("length", "3.0", "3.0"),
        ("length", "None", "None"),
        ("length", "2147483648", "2147483648"),
        ("length", "[1]", "[1]"),
        ("length", "f'{other}'", "f'{other}'"),
        ("length", "str(other)", "str(other)"),
        ("length", "3 if other else 'x'", "'x'"),
        ("length", "self.parameters.device", "self.parameters.device"),
        ("length", "self.mouth_proxy.close()", "self.mouth_proxy.close()"),
        ("length", "self.mouth_proxy.where", "self.mouth_proxy.where"),
        ("length", "self.mouth_proxy.where()", "self.mouth_proxy.where()"),
        ("length", "RoboCompVoice.Tone.high", "RoboCompVoice.Tone.high"),
        ("length", "1, 2", "1, 2"),
        ("small", "256", "256"),
        ("small", "-1", "-1"),
        ("loud", "'x'", "'x'"),
        ("loud", "None", "None"),
        ("name", "3", "3"),
        ("name", "'a',", "'a',"),
        ("isOn", "'yes'", "'yes'"),
        ("tone", "'high'", "'high'"),
        ("tone", "0", "0"),
        ("tone", "None", "None"),
        ("tone", "RoboCompVoice.Tone", "RoboCompVoice.Tone"),
        ("tone", "RoboCompMouth.Shape.wide", "RoboCompMouth.Shape.wide"),
        ("sound", "{'pitch': 1}", "{'pitch': 1}"),
        ("sound", "1.5, other", "1.5, other"),
        ("sound", "RoboCompMouth.Pose()", "RoboCompMouth.Pose()"),
        ("sound", "RoboCompVoice.Sound", "RoboCompVoice.Sound"),
        ("sound", "self.parameters.motors[0]", "self.parameters.motors[0]"),
        ("words", "{'a'}", "{'a'}"),
        ("words", "(word for word in other)", "(word for word in other)"),
        ("words", "map(str, other)", "map(str, other)"),
        ("words", "['a', 3]", "3"),
        ("sounds", "'ab'", "'ab'"),
        ("raw", "[1, 300]", "300"),
        ("counts", "[]", "[]"),
        ("both", "RoboCompVoice.Sound()", "RoboCompVoice.Sound()"),
        ("both", "None", "None"),
        ("both", "RoboCompVoice.Sound(), 1, 2", "RoboCompVoice.Sound(), 1, 2"),
        ("both", "1, RoboCompVoice.Sound()", "1"),
        ("both", "RoboCompVoice.Sound(), 'x'", "'x'"),
    ],
)  # fmt: skip
def test_results_of_a_wrong_type(link: Link, name: str, value: str, at: str) -> None:
    assert ("RC6335", at) in found(link(voice("python")), method(name, f"return {value}"))


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("length", ["3", "True", "-1", "2147483647", "len(other)", "int(1.5)", "other", "other or 3", "self.own", "3 // 2"]),
        ("length", ["self.parameters.speed", "self.Voice_small()", "other if other else 3", "max(1, 2)", "2 ** 31"]),
        ("small", ["0", "255", "ord('a')"]),
        ("loud", ["3", "1.5", "self.parameters.speed", "10 ** 20"]),
        ("name", ["None", "'x'", "f'{other}'", "'a' + other", "'%s' % other", "self.parameters.device", "'' or other"]),
        ("isOn", ["1", "None", "other > 3", "not other", "bool(other)", "other and 'x'"]),
        ("tone", ["RoboCompVoice.Tone.low", "RoboCompVoice.Tone.valueOf(1)", "other"]),
        ("sound", ["None", "RoboCompVoice.Sound(1.5)", "other", "self.mouth_proxy.anything", "RoboCompVoice.Sound()"]),
        ("sounds", ["[]", "None", "(RoboCompVoice.Sound(),)", "[RoboCompVoice.Sound() for _ in other]", "other"]),
        ("words", ["'ab'", "['a']", "('a', 'b')", "sorted(other)", "list(other)", "self.parameters.device.split()"]),
        ("raw", ["b'x'", "bytes(3)", "bytearray(3)", "[1, 255]", "other.tobytes()", "[]"]),
        ("counts", ["{}", "None", "dict(a=1)", "other | other", "other + other", "{word: 1 for word in other}"]),
        ("both", ["RoboCompVoice.Sound(), 3", "[RoboCompVoice.Sound(), 3]", "other", "*other, 3", "self.mouth_proxy.where()"]),
        ("both", ["(None, 3)", "tuple(other)"]),
        ("say", ["3", "None", "'x'"]),
    ],
)  # fmt: skip
def test_results_that_are_right_or_unknown(link: Link, name: str, values: list[str]) -> None:
    for value in values:
        files = method(name, f"self.own = other\nanything = 1\nreturn {value}")
        assert [one for one in found(link(voice("python")), files) if one[0] == "RC6335"] == [], value


@pytest.mark.parametrize(
    ("body", "head"),
    [
        ("def inner():\n    return 'x'\nreturn len(inner())", "def Voice_length(self):"),
        ("return (lambda: 'x')", "@decorated\ndef Voice_length(self):"),
        ("return 'x'", "def helper(self):"),
        ("value = 'x'\nvalue = len(value)\nreturn value", "def Voice_length(self):"),
    ],
)
def test_what_is_no_result_of_the_method(link: Link, body: str, head: str) -> None:
    assert found(link(voice("python")), method("", body, head)) == []


@pytest.mark.parametrize(
    ("body", "is_reported"),
    [
        ("if other:\n    other.clear()", True),
        ("with other:\n    other.clear()", True),
        ("try:\n    other.clear()\nexcept ValueError:\n    raise", True),
        ("for one in other:\n    print(one)", True),
        ("while other:\n    other.pop()", True),
        ("while True:\n    if other:\n        break", True),
        ("match other:\n    case 1:\n        raise ValueError", True),
        ("return", True),
        ("print((lambda: 3)())", True),
        ("def inner():\n    return 3\ninner()", True),
        ("...", True),
        ("if other:\n    return 3", False),
        ("raise NotImplementedError", False),
        ("raise RoboCompVoice.Hoarse('x')", False),
        ("while True:\n    other.clear()", False),
        ("if other:\n    raise ValueError\nelse:\n    raise KeyError", False),
        ("try:\n    raise ValueError\nfinally:\n    other.clear()", False),
        ("match other:\n    case 1:\n        raise ValueError\n    case _:\n        raise KeyError", False),
        ("other.clear()\nimport sys\nsys.exit(1)", False),
        ("self.refuse()\n\ndef refuse():\n    pass", False),
        ("assert False, 'never'", False),
    ],
)
def test_methods_without_a_result(link: Link, body: str, is_reported: bool) -> None:
    files = method("length", body)
    files["specificworker.py"] += "\n    def refuse(self):\n        raise NotImplementedError\n"
    assert ("RC6329" in {code for code, _ in found(link(voice("python")), files)}) is is_reported


def test_a_method_that_a_derived_class_replaces_may_return_nothing(link: Link) -> None:
    base = "\n\nclass Base(GenericWorker):\n    def Voice_length(self):\n        pass\n"
    main = "\n\nclass SpecificWorker(Base):\n    def Voice_length(self):\n        return 3\n"
    assert found(link(voice("python")), {"specificworker.py": HEAD + base + main}) == []
    assert found(link(voice("python")), {"specificworker.py": HEAD + base}) == [("RC6329", "Voice_length")]


@pytest.mark.parametrize(
    ("head", "body"),
    [
        ("async def Voice_say(self, text):", "pass"),
        ("async def Voice_length(self):", "return 3"),
        ("async def compute(self):", "pass"),
        ("async def sm_silent(self):", "pass"),
        ("def Voice_say(self, text):", "yield text"),
        ("def Voice_words(self):", "for one in other:\n    yield one"),
        ("def initialize(self):", "yield from other"),
        ("@property\ndef Voice_length(self):", "return 3"),
        ("@property\ndef Voice_length(self):", "return len(other)"),
        ("@property\ndef Voice_say(self, text):", "return other"),
        ("@staticmethod\ndef Voice_length(self):", "return 3"),
    ],
)
def test_methods_that_the_generated_code_cannot_call(link: Link, head: str, body: str) -> None:
    name = head.partition("def ")[2].partition("(")[0]
    reported = found(link(voice("python", MACHINE)), method("", body, head))
    assert reported == [("RC6336", name)]


@pytest.mark.parametrize(
    ("head", "body"),
    [
        ("async def later(self):", "pass"),
        ("@decorated\nasync def Voice_say(self, text):", "pass"),
        ("def helper(self):", "yield 3"),
        ("def Voice_both(self):", "yield RoboCompVoice.Sound()\nyield 3"),
        ("def Voice_length(self):", "def each():\n    yield 3\nreturn sum(each())"),
        ("@property\ndef Voice_length(self):", "return self.other"),
        ("@property\ndef Voice_length(self):", "return lambda: 3"),
        ("@property\ndef Voice_length(self):", "return other(self)"),
        ("@property\ndef helper(self):", "return 3"),
        ("@staticmethod\ndef Voice_length():", "return 3"),
        ("@staticmethod\ndef Voice_say(text):", "print(text)"),
        ("@classmethod\ndef Voice_length(cls):", "return 3"),
    ],
)
def test_methods_that_the_generated_code_can_call(link: Link, head: str, body: str) -> None:
    files = method("", f"other = 3\n{body}" if "self.other" not in body else body, head)
    files["specificworker.py"] += (
        "\n    def __init__(self, *given):\n        super().__init__(*given)\n        self.other = len\n"
    )
    assert found(link(voice("python", MACHINE)), files) == []


def test_a_value_instead_of_a_method(link: Link) -> None:
    text = HEAD + NAMES + "    Voice_length = 3\n    limit = 4\n    Voice_name = other\n"
    assert found(link(voice("python")), {"specificworker.py": text}) == [("RC6336", "Voice_length")]


HEADER = """\
#pragma once
#include "genericworker.h"
class SpecificWorker : public GenericWorker
{
public:
    int Voice_length();
    RoboCompVoice::Sound Voice_both(int& age);
};
"""


@pytest.mark.parametrize(
    ("body", "is_reported"),
    [
        ("", True),
        ("turns++; if (a) { b(); }", True),
        ("for (int i = 0; i < 3; i++) f(i);", True),
        ("auto f = [] { return 3; }; f();", True),
        ("return 3;", False),
        ("if (a) return 3;", False),
        ('throw RoboCompVoice::Hoarse("x");', False),
        ("while (true) f();", False),
        ("for (;;) f();", False),
        ("std::abort();", False),
        ("FAIL(x)", False),
        ("\n#ifdef A\n    return 3;\n#endif\n", False),
        ("try { return f(); } catch (...) { }", False),
        ("a = = 3;", False),
        ("[[noreturn]] void f(); f();", False),
    ],
)
def test_methods_without_a_result_in_cpp(link: Link, body: str, is_reported: bool) -> None:
    source = f'#include "specificworker.h"\nint SpecificWorker::Voice_length()\n{{\n    {body}\n}}\n'
    source += "RoboCompVoice::Sound SpecificWorker::Voice_both(int& age) { age = 3; return {}; }\n"
    reported = found(link(voice("cpp")), {"specificworker.h": HEADER, "specificworker.cpp": source})
    assert reported == ([("RC6329", "Voice_length")] if is_reported else [])
