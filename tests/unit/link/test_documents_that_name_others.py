"""Documents that name each other: diagnostics if one is missing, is of another kind, or does not name the other."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from in_memory import said

C = "component: SpeechComp\nlanguage: python\n"
P = "component: speech.cdsl.yaml\nparameters: {a: {type: int, default: 1}}\n"
A = "module: RoboCompA\n"
CASES: dict[str, dict[str, str]] = {
    "parameters that are not there": {"speech.cdsl.yaml": C + "parameters: spech.pdsl.yaml\n", "speech.pdsl.yaml": P},
    "parameters without their ending": {"speech.cdsl.yaml": C + "parameters: speech\n", "speech.pdsl.yaml": P},
    "parameters in no folder": {"speech.cdsl.yaml": C + "parameters: nowhere/speech.pdsl.yaml\n"},
    "parameters that are a folder": {
        "speech.cdsl.yaml": C + "parameters: more\n",
        "more/x.pdsl.yaml": "parameters: {}\n",
    },
    "parameters that are a component": {
        "speech.cdsl.yaml": C + "parameters: speech.cdsl.yaml\n",
        "other.pdsl.yaml": "parameters: {a: int}\n",
    },
    "parameters that are no document": {"speech.cdsl.yaml": C + "parameters: notes.txt\n", "notes.txt": "x"},
    "a component that is not there": {
        "speech.cdsl.yaml": C,
        "x.pdsl.yaml": "component: spech.cdsl.yaml\nparameters: {a: int}\n",
    },
    "a component by its name": {"speech.cdsl.yaml": C, "x.pdsl.yaml": "component: SpeechComp\nparameters: {a: int}\n"},
    "a component by its name elsewhere": {
        "s/speech.cdsl.yaml": C,
        "p/x.pdsl.yaml": "component: SpeechComp\nparameters: {a: int}\n",
        "rcyaml.yaml": "{}\n",
    },
    "a component that is a folder": {"s/speech.cdsl.yaml": C, "x.pdsl.yaml": "component: s\nparameters: {a: int}\n"},
    "a component that is an interface": {
        "A.idsl.yaml": A,
        "speech.cdsl.yaml": C,
        "x.pdsl.yaml": "component: A.idsl.yaml\nparameters: {a: int}\n",
    },
    "two documents for one component": {"speech.cdsl.yaml": C, "speech.pdsl.yaml": P, "more.pdsl.yaml": P},
    "the component names another than names it": {
        "speech.cdsl.yaml": C + "parameters: more.pdsl.yaml\n",
        "speech.pdsl.yaml": P,
        "more.pdsl.yaml": "parameters: {a: int}\n",
    },
    "parameters of another component": {
        "speech.cdsl.yaml": C + "parameters: other/o.pdsl.yaml\n",
        "other/o.cdsl.yaml": "component: O\nlanguage: python\n",
        "other/o.pdsl.yaml": "component: o.cdsl.yaml\nparameters: {a: int}\n",
    },
    "parameters that nobody claims": {"speech.cdsl.yaml": C, "x.pdsl.yaml": "parameters: {a: int}\n"},
    "parameters elsewhere": {
        "speech/speech.cdsl.yaml": C,
        "p/x.pdsl.yaml": "component: ../speech/speech.cdsl.yaml\nparameters: {a: {type: int, default: 1}}\n",
    },
    "values of no component": {"speech.cdsl.yaml": C, "speech.pdsl.yaml": P, "x.config.yaml": "parameters: {a: 2}\n"},
    "values of a component that is not there": {
        "speech.cdsl.yaml": C,
        "speech.pdsl.yaml": P,
        "x.config.yaml": "component: spech.cdsl.yaml\nparameters: {a: 2}\n",
    },
    "values by the parameters": {
        "speech.cdsl.yaml": C,
        "speech.pdsl.yaml": P,
        "x.config.yaml": "component: speech.pdsl.yaml\nparameters: {a: x}\n",
    },
    "values of the component around": {
        "speech.cdsl.yaml": C,
        "speech.pdsl.yaml": P,
        "etc/config.yaml": "parameters: {a: x}\n",
    },
    "values that extend what is not there": {
        "speech.cdsl.yaml": C,
        "speech.pdsl.yaml": P,
        "x.config.yaml": "component: speech.cdsl.yaml\nextends: [bse.config.yaml]\n",
        "base.config.yaml": "parameters: {a: 2}\n",
    },
    "values that extend themselves": {
        "speech.cdsl.yaml": C,
        "speech.pdsl.yaml": P,
        "x.config.yaml": "component: speech.cdsl.yaml\nextends: [x.config.yaml]\n",
    },
    "values that extend each other": {
        "speech.cdsl.yaml": C,
        "speech.pdsl.yaml": P,
        "x.config.yaml": "component: speech.cdsl.yaml\nextends: [y.config.yaml]\n",
        "y.config.yaml": "component: speech.cdsl.yaml\nextends: [x.config.yaml]\n",
    },
    "values that extend those of another component": {
        "speech.cdsl.yaml": C,
        "speech.pdsl.yaml": P,
        "x.config.yaml": "component: speech.cdsl.yaml\nextends: [o/y.config.yaml]\n",
        "o/o.cdsl.yaml": "component: O\nlanguage: python\n",
        "o/y.config.yaml": "component: o.cdsl.yaml\n",
    },
    "an import that is not there": {"A.idsl.yaml": A + "imports: [B]\n", "Bb.idsl.yaml": "module: RoboCompBb\n"},
    "an import of itself": {"A.idsl.yaml": A + "imports: [A]\n"},
    "imports in a circle": {
        "A.idsl.yaml": A + "imports: [B]\n",
        "B.idsl.yaml": "module: RoboCompB\nimports: [D]\n",
        "D.idsl.yaml": "module: RoboCompD\nimports: [B]\n",
    },
    "an import twice": {"A.idsl.yaml": A + "imports: [B, B]\n", "B.idsl.yaml": "module: RoboCompB\n"},
    "an import by its old name": {"A.idsl.yaml": A + "imports: [B.idsl]\n", "B.idsl.yaml": "module: RoboCompB\n"},
    "an import by a path": {"A.idsl.yaml": A + "imports: [sub/B]\n", "sub/B.idsl.yaml": "module: RoboCompB\n"},
    "two modules of one name": {
        "A.idsl.yaml": A,
        "B.idsl.yaml": A,
        "c.cdsl.yaml": "component: C\nlanguage: python\nimports: [A, B]\n",
    },
    "an interface that is not there": {
        "A.idsl.yaml": A + "interfaces: {Arm: {methods: {go: }}}\n",
        "c.cdsl.yaml": "component: C\nlanguage: python\nimports: [A]\nimplements: [Amr]\n",
    },
    "an interface of two modules": {
        "A.idsl.yaml": A + "interfaces: {Arm: {methods: {go: }}}\n",
        "B.idsl.yaml": "module: RoboCompB\ninterfaces: {Arm: {methods: {go: }}}\n",
        "c.cdsl.yaml": "component: C\nlanguage: python\nimports: [A, B]\nimplements: [Arm]\n",
    },
    "a topic that is an interface": {
        "A.idsl.yaml": A + "interfaces: {Arm: {methods: {go: }}}\n",
        "c.cdsl.yaml": "component: C\nlanguage: python\nimports: [A]\npublishes: [Arm]\n",
    },
    "an interface without its import": {
        "A.idsl.yaml": A + "interfaces: {Arm: {methods: {go: }}}\n",
        "c.cdsl.yaml": "component: C\nlanguage: python\nimplements: [Arm]\n",
    },
    "a broken import": {
        "A.idsl.yaml": "module: [\n",
        "c.cdsl.yaml": "component: C\nlanguage: python\nimports: [A]\nimplements: [Arm]\n",
    },
    "options that mean nothing": {"A.idsl.yaml": A, "rcyaml.yaml": "lnt: {}\n"},
    "a lint of no code": {"A.idsl.yaml": A, "rcyaml.yaml": "lint: {RC9999: 'off', RC1001: loud}\n"},
    "imports in a circle of three": {
        "X.idsl.yaml": "module: RoboCompX\nimports: [Z]\n",
        "Z.idsl.yaml": "module: RoboCompZ\nimports: [Y]\n",
        "Y.idsl.yaml": "module: RoboCompY\nimports: [X]\n",
        "W.idsl.yaml": "module: RoboCompW\nimports: [X]\n",
    },
    "imports in two circles": {
        "D.idsl.yaml": "module: RoboCompD\nimports: [C]\n",
        "C.idsl.yaml": "module: RoboCompC\nimports: [D]\n",
        "B.idsl.yaml": "module: RoboCompB\nimports: [A]\n",
        "A.idsl.yaml": "module: RoboCompA\nimports: [B]\n",
    },
    "an interface that is nowhere": {"c.cdsl.yaml": "component: C\nlanguage: python\nimplements: [Arm]\n"},
    "an interface that is there already": {
        "A.idsl.yaml": A + "interfaces: {Arm: {methods: {go: }}}\n",
        "c.cdsl.yaml": "component: C\nlanguage: python\nimports: [A]\nimplements: [Arm, Amr]\n",
    },
    "an interface that no import defines, of several": {
        "A.idsl.yaml": A + "interfaces: {Arm: {methods: {go: }}, Leg: {methods: {go: }}}\n",
        "c.cdsl.yaml": "component: C\nlanguage: python\nimports: [A]\nimplements: [Camera]\n",
    },
    "a name that a topic has": {
        "A.idsl.yaml": A + "topics: {Arm: {methods: {go: }}}\nexceptions: {Arm: {struct: {x: int}}}\n"
    },
    "values called config.yaml elsewhere": {
        "speech.cdsl.yaml": C,
        "speech.pdsl.yaml": P,
        "config.yaml": "parameters: {a: x}\n",
    },
    "values in a folder below etc": {
        "speech.cdsl.yaml": C,
        "speech.pdsl.yaml": P,
        "etc/more/config.yaml": "parameters: {a: x}\n",
    },
    "values in the etc of two components": {
        "a.cdsl.yaml": "component: A\nlanguage: python\n",
        "b.cdsl.yaml": "component: B\nlanguage: python\n",
        "etc/config.yaml": "parameters: {a: x}\n",
    },
    "values in the etc of another component": {
        "speech.cdsl.yaml": C,
        "speech.pdsl.yaml": P,
        "o/o.cdsl.yaml": "component: O\nlanguage: python\n",
        "o/etc/config.yaml": "component: ../../speech.cdsl.yaml\nparameters: {a: 2}\n",
    },
    "a machine that includes itself": {
        "c.cdsl.yaml": "component: C\nlanguage: python\nstatemachine: m.scxml\n",
        "m.scxml": '<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" initial="a"><state id="a"><invoke src="m.scxml"/></state></scxml>\n',
    },
    "a machine that is a folder": {
        "c.cdsl.yaml": "component: C\nlanguage: python\nstatemachine: m\n",
        "m/x.txt": "",
    },
    "a machine that includes what is no machine": {
        "c.cdsl.yaml": "component: C\nlanguage: python\nstatemachine: m.scxml\n",
        "n.scxml": "<x/>\n",
        "m.scxml": '<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" initial="a"><state id="a"><invoke src="file:n.scxml"/></state></scxml>\n',
    },
}


def test_the_diagnostics_of_references(golden: Callable[[str, Mapping[str, str]], None]) -> None:
    golden("named", {"said.txt": "\n".join(_shown(name, documents) for name, documents in CASES.items())})


def _shown(name: str, documents: dict[str, str]) -> str:
    lines = [f"{name}:"]
    for one in said(documents):
        lines += [f"  {one.code} in {one.file}, at `{one.at}`: {one.message}"]
        lines += [f"    hint: {one.hint}"] if one.hint else []
        lines += [f"    {text}: `{place}`" for text, place in one.related]
    return "\n".join([*(lines if len(lines) > 1 else [f"{name}: nothing is wrong"]), ""])
