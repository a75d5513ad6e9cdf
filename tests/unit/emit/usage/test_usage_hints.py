"""What is reported in Python about values that only an annotation, or a call of the code's own functions, describes."""

from __future__ import annotations

import textwrap

import pytest

from judged_code import Link, component, found

HEAD = """\
import functools
from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple, Optional, Union

from generated.genericworker import GenericWorker
from generated.interfaces import RoboCompMouth
from elsewhere import thing

MouthPrx = RoboCompMouth.MouthPrx
"""
FUNCTIONS = """\


def made(a, b=2):
    return a


def pose_of() -> RoboCompMouth.Pose:
    return thing()


class Plain:
    def __init__(self, a):
        self.a = a


class Bare:
    x = 1


class Derived(Plain):
    pass


class Made:
    def __new__(cls, a):
        return object.__new__(cls)


@dataclass
class Data:
    a: int


class Pair(NamedTuple):
    a: int
    b: int


if thing:
    def either(a):
        pass
else:
    def either():
        pass
"""
CLASS = """\


class SpecificWorker(GenericWorker):
    held: RoboCompMouth.MouthPrx

    def own(self, a, b=2):
        return a

    def only(self, a, *, key):
        return key

    def many(self, *a, **k):
        return a

    @staticmethod
    def fixed(a):
        return a

    @functools.cache
    def cached(self, a):
        return a

    def pose(self) -> RoboCompMouth.Pose:
        return thing()

    def Ear_hear(self, text):
        pass
"""


def worker(text: str) -> dict[str, str]:
    """`text` is the body of compute(), or methods."""
    text = textwrap.dedent(text)
    text = text if text.startswith(("def ", "async ")) else "def compute(self):\n" + textwrap.indent(text, "    ")
    return {"specificworker.py": HEAD + FUNCTIONS + CLASS + "\n" + textwrap.indent(text, "    ") + "\n"}


def helper(hint: str, body: str) -> str:
    return f"def helper(self, it: {hint}):\n    {body}"


@pytest.mark.parametrize(
    ("text", "code", "at"),
    [
        *(
            (helper(hint, "it.shut()"), "RC6302", "shut")
            for hint in (
                "RoboCompMouth.MouthPrx", "MouthPrx", '"RoboCompMouth.MouthPrx"', "RoboCompMouth.MouthPrx | None",
                "Optional[MouthPrx]", "Union[None, MouthPrx]", "Annotated[MouthPrx, 3]", "'MouthPrx | None'",
            )
        ),
        (helper("RoboCompMouth.Pose = None", "print(it.openning)"), "RC6325", "openning"),
        (helper("list[RoboCompMouth.Pose]", "print(it[0].openning)"), "RC6325", "openning"),
        (helper("'list[RoboCompMouth.Pose]'", "[one.openning for one in it]"), "RC6325", "openning"),
        (helper("tuple[RoboCompMouth.Pose, ...]", "print(it[-1].openning)"), "RC6325", "openning"),
        (helper("dict[str, RoboCompMouth.Pose]", "print(it['a'].openning)"), "RC6325", "openning"),
        (helper("dict[str, RoboCompMouth.Pose]", "[one.openning for one in it.values()]"), "RC6325", "openning"),
        (helper("'SpecificWorker'", "it.moth_proxy.close()"), "RC6301", "moth_proxy"),
        (helper("GenericWorker", "it.log.inform('a')"), "RC6325", "inform"),
        ("it: MouthPrx = thing()\nit.shut()", "RC6302", "shut"),
        ("it: MouthPrx\nit = thing()\nit.shut()", "RC6302", "shut"),
        ("self.held.shut()", "RC6302", "shut"),
        ("self.one: RoboCompMouth.Pose = thing()\nprint(self.one.openning)", "RC6325", "openning"),
        ("print(self.pose().openning)", "RC6325", "openning"),
        ("it = self.pose()\nprint(it.openning)", "RC6325", "openning"),
        ("print(pose_of().openning)", "RC6325", "openning"),
        ("MouthPrx.checkedCast(self.mouth_proxy).shut()", "RC6302", "shut"),
        ("it = RoboCompMouth.MouthPrx.uncheckedCast(thing())\nit.shut()", "RC6302", "shut"),
        ("self.mouth_proxy.ice_oneway().shut()", "RC6302", "shut"),
        ("it = self.mouth_proxy.ice_timeout(3)\nit.shut()", "RC6302", "shut"),
        ("self.mouth_proxy.ice_pign()", "RC6302", "ice_pign"),
        ("if (it := self.mouth_proxy):\n    it.shut()", "RC6302", "shut"),
        ("it, n = self.mouth_proxy, 3\nit.shut()", "RC6302", "shut"),
        ("it = self.mouth_proxy or None\nit.shut()", "RC6302", "shut"),
        ("it = self.mouth_proxy if thing else None\nit.shut()", "RC6302", "shut"),
        ("for n, m in enumerate(self.parameters.motors):\n    print(m.velo)", "RC6306", "velo"),
        ("for n, m in zip(thing, self.parameters.motors):\n    print(m.velo)", "RC6306", "velo"),
        ("print([m.velo for n, m in enumerate(self.parameters.motors, 1)])", "RC6306", "velo"),
        ("print(sorted(self.parameters.motors, key=str)[0].velo)", "RC6306", "velo"),
        ("for m in reversed(self.parameters.motors):\n    print(m.velo)", "RC6306", "velo"),
        ("m = max(self.parameters.motors, key=str)\nprint(m.velo)", "RC6306", "velo"),
        ("self.own()", "RC6304", "own"),
        ("self.own(1, 2, 3)", "RC6304", "own"),
        ("self.own(1, c=3)", "RC6305", "c"),
        ("self.only(1)", "RC6304", "only"),
        ("self.fixed()", "RC6304", "fixed"),
        ("self.Ear_hear()", "RC6304", "Ear_hear"),
        ("made()", "RC6304", "made"),
        ("Plain()", "RC6304", "Plain"),
        ("Bare(3)", "RC6304", "Bare"),
        ("print('at ' + self.parameters.speed)", "RC6337", "speed"),
        ("print(self.parameters.device + 1)", "RC6337", "device"),
        ("print(f'{thing}' + self.parameters.speed)", "RC6337", "speed"),
        ("print(self.mouth_proxy.move(RoboCompMouth.Pose(), True) + 1)", "RC6337", "move"),
        ("if self.mouth_proxy.close():\n    pass", "RC6326", "close"),
        ("while not self.mouth_proxy.close():\n    pass", "RC6326", "close"),
        ("for one in self.mouth_proxy.close():\n    pass", "RC6326", "close"),
        ("for one in self.mouth_proxy.move(RoboCompMouth.Pose(), True):\n    pass", "RC6326", "move"),
    ],
)  # fmt: skip
def test_what_is_certain(link: Link, text: str, code: str, at: str) -> None:
    assert found(link(component("python")), worker(text)) == [(code, at)]


@pytest.mark.parametrize(
    "text",
    [
        helper("RoboCompMouth.Pose", "it = str(it); print(it.upper())"),
        helper("'RoboCompMouth.Pose | str'", "print(it.upper())"),
        helper("Union[MouthPrx, Plain]", "it.shut()"),
        helper("Any", "it.shut()"),
        helper("'not( valid'", "it.shut()"),
        helper("3", "it.shut()"),
        helper("type[RoboCompMouth.Pose]", "print(it.__name__, it.anything)"),
        helper("'Callable[[int], RoboCompMouth.Pose]'", "print(it(1).openning)"),
        helper("RoboCompMouth.Pose", "print(it.label if hasattr(it, 'label') else 0)"),
        helper("RoboCompMouth.Pose", "try: print(it.openning)\n    except AttributeError: pass"),
        helper("RoboCompMouth.Shape", "print(it.name, it.value)"),
        helper("'RoboCompMouth.Path'", "print(it[0].opening, len(it))"),
        helper("list[RoboCompMouth.Pose]", "it.append(3); print(it[1:], it.pop().opening, it.anything)"),
        helper("dict[str, RoboCompMouth.Pose]", "[k.upper() for k, v in it.items()]; it.update({}); it.anything"),
        helper("MouthPrx", "it.ice_ping(); it.ice_later(); it.ice_oneway().close(); it.closeAsync().result()"),
        "def other(self, *it: MouthPrx, **more: MouthPrx):\n    print(it.count(3), more.keys())",
        "async def later(self) -> RoboCompMouth.Pose:\n    return thing()\n\ndef other(self):\n    self.later().close()",
        "def other(self):\n    print(self.now.opening, self.now.label)\n\n@property\ndef now(self) -> RoboCompMouth.Pose:\n    return thing()",
        "it: RoboCompMouth.Pose = thing()\nit = str(it)\nprint(it.upper())",
        "self.pose.anything",
        "it = self.pose\nprint(it.anything)",
        "it = pose_of\nprint(it.anything)",
        "MouthPrx.ice_staticId(); MouthPrx.anything",
        "self.own(1); self.own(1, 2); self.own(1, b=2); self.own(*thing); self.own(**thing); self.own(a=1)",
        "self.only(1, key=2); self.many(1, 2, z=3); self.cached(); self.fixed(1); SpecificWorker.own(self, 1)",
        "try:\n    self.own()\nexcept TypeError:\n    pass",
        "self.own = thing\nself.own()",
        "setattr(self, 'own', thing)\nself.own()",
        "made(1); made(1, 2); made(*thing); Plain(1); Bare(); Derived(1); Derived(); Made(1); Data(1); Pair(1, 2)",
        "either(); either(1)",
        "made = thing\nmade()",
        "def other(self, made):\n    made()",
        "it = self.mouth_proxy or thing\nit.shut()",
        "it = self.mouth_proxy if thing else self\nit.shut()",
        "it, *more = self.mouth_proxy, 1\nmore.append(3)",
        "a, b = 1, 2\na, b = b, a\nprint(a.real)",
        "for n, m in enumerate(self.parameters.motors):\n    print(n.real, m.vel)",
        "for pair in zip(thing, self.parameters.motors):\n    print(pair[0].x, pair[1].vel)",
        "def other(self, enumerate):\n    for n, m in enumerate(self.parameters.motors):\n        print(m.velo)",
        "print(max(self.parameters.motors, key=str, default=thing).velo)",
        "print(max(self.parameters.speed, 2).real, sorted({'a': self.mouth_proxy})[0].upper(), max(thing).x)",
        "print(self.parameters.speed + 1.5, 'a' + self.parameters.device, 'a' + str(self.parameters.speed))",
        "print('n: %d' % self.parameters.speed, 'a' * self.parameters.speed, True + self.parameters.speed)",
        "try:\n    print('a' + self.parameters.speed)\nexcept TypeError:\n    pass",
        "print(thing + self.parameters.speed, self.parameters.words + ('a',))",
        "it = self.mouth_proxy.close()\nif it is None or self.mouth_proxy.move(RoboCompMouth.Pose(), True):\n    pass",
        "for one in self.mouth_proxy.way():\n    print(one.opening)",
    ],
)  # fmt: skip
def test_what_is_right_or_not_certain(link: Link, text: str) -> None:
    assert found(link(component("python")), worker(text)) == []
