"""The text of the Slice target."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from pathlib import Path

from conftest import Tree, write_tree
from robocomp_yaml import pipeline
from robocomp_yaml.emit import slice as target
from robocomp_yaml.model.interface import Module, Struct

TYPES = """\
module: RoboCompTypes
doc: Types that many modules share.
types:
  Pose:
    doc: Where something is, on the floor.
    struct:
      x: {type: float, unit: m}
      y: {type: float, unit: m}
      alpha: {type: float, default: 0, unit: rad, doc: Around the vertical axis}
  Side: {enum: [left, right]}
exceptions:
  HardwareFailed: {doc: The device does not answer., struct: {what: string}}
"""
EVERYTHING = r'''
module: RoboCompEverything
doc: |
  One of everything.

  - a list, with */ and /* and \u and """ in it
  - a line that is so long that a person would have broken it in two, because nobody likes to read such lines as this
imports: [Types]
constants:
  limit: {type: int, value: 100, unit: percent}
  greeting: {type: string, value: "\"Hi\",\n\tand \\ went??! é", doc: What it says first.}
  ratio: {type: double, value: .9}
  huge: {type: double, value: 99999999999999999999}
  limit_m: {type: float, value: 1e6, unit: m}
  isOn: {type: bool, value: True}
  mother: {type: Language, value: english}
  side: {type: Types.Side, value: right}
types:
  Route: {doc: Where to go., sequence: Types.Pose}
  Utterance:
    doc: One thing to say.
    struct:
      text: string
      speed: {type: float, default: 1.0, unit: words/s, doc: Spoken words per second.}
      language: {type: Language, default: english}
      volume_level: int
  Language: {doc: What we speak., enum: {spanish: , english: {value: 5, doc: Any English.}, french: 7}}
  Lexicon: {map: {key: string, value: Utterances}}
  Utterances: {sequence: Utterance}
exceptions:
  Busy: {doc: Somebody else is speaking.}
  Muted: {struct: {since: {type: long, unit: s}}}
interfaces:
  Speech:
    doc: Says things.
    methods:
      say:
        doc: Says a text.
        in: {text: {type: string, doc: What to say.}, overwrite: bool, speed: {type: float, unit: words/s}}
        returns: {type: bool, doc: Whether it was said.}
        throws: [Busy, Types.HardwareFailed]
      isBusy: {returns: bool, idempotent: true}
      status: {out: {volume: int, queue: Utterances}}
      reset:
      utterance: {doc: The last one., returns: Utterance}
      configure:
        in: {first: Types.Pose, second: Types.Pose, third: Types.Pose, fourth: Types.Pose}
        out: {room: int}
        throws: [Muted, Busy]
  Nothing: {}
topics:
  SpeechEvents: {methods: {spoken: {in: {utterance: Utterance}}}}
'''.lstrip()


def texts(folder: Path, files: Tree) -> Mapping[str, str]:
    """The Slice of the modules of a tree that has no errors."""
    analysis = pipeline.analyse([str(write_tree(folder, files))])
    assert not analysis.diagnostics
    return {target.file_name(linked): target.text(linked) for linked in analysis.program.modules.values()}


def body(folder: Path, text: str) -> list[str]:
    """The lines between the braces of the module M of M.idsl.yaml."""
    lines = texts(folder, {"M.idsl.yaml": "module: M\n" + text, "Types.idsl.yaml": TYPES})["M.ice"].splitlines()
    return lines[lines.index("{") + 1 : lines.index("};")]


def test_everything(golden: Callable[[str, Mapping[str, str]], None], tmp_path: Path) -> None:
    golden("slice", texts(tmp_path, {"Everything.idsl.yaml": EVERYTHING, "Types.idsl.yaml": TYPES}))


def test_the_text_does_not_depend_on_the_order_of_files(tmp_path: Path) -> None:
    names = ["Everything.idsl.yaml", "Types.idsl.yaml", "Third.idsl.yaml"]
    write_tree(
        tmp_path, dict(zip(names, [EVERYTHING, TYPES, "module: RoboCompThird\nimports: [Everything]\n"], strict=True))
    )
    seen = []
    for order in itertools.permutations(names):
        program = pipeline.analyse([str(tmp_path / name) for name in order]).program
        seen.append({target.file_name(linked): target.text(linked) for linked in program.modules.values()})
    assert all(one == seen[0] for one in seen)


def test_definitions_follow_what_they_use_else_the_authors_order(tmp_path: Path) -> None:
    types = "types: {A: {sequence: C}, B: {sequence: int}, C: {struct: {d: D}}, D: {enum: [x]}, E: {sequence: B}}\n"
    lines = body(tmp_path, types)
    starts = [line for line in lines if line.startswith(("  s", "  e"))]
    assert starts == ["  enum D { x };", "  struct C", "  sequence<C> A;", "  sequence<int> B;", "  sequence<B> E;"]


def test_a_deep_chain_of_types(tmp_path: Path) -> None:
    depth = 300
    types = "".join(f"  T{n}: {{sequence: T{n + 1}}}\n" for n in range(depth))
    lines = body(tmp_path, f"types:\n{types}  T{depth}: {{sequence: int}}\n")
    assert [line for line in lines if line][:2] == [f"  sequence<int> T{depth};", f"  sequence<T{depth}> T{depth - 1};"]


def test_the_type_of_a_method_with_the_same_name_is_absolute(tmp_path: Path) -> None:
    """Else Slice reports that the name changed its meaning."""
    text = (
        "imports: [Types]\ntypes: {Pose: {struct: {x: int}}, RoboCompTypes: {struct: {pose: Types.Pose}}}\n"
        "interfaces: {I: {methods: {pose: {in: {p: Pose}, returns: Pose}}}}\n"
    )
    lines = body(tmp_path, text)
    assert "    ::M::Pose pose(::M::Pose p);" in lines
    assert "    ::RoboCompTypes::Pose pose;" in lines


def test_underscores_are_declared_if_used(tmp_path: Path) -> None:
    plain = texts(tmp_path, {"M.idsl.yaml": "module: M\ntypes: {A: {struct: {b: int}}}\n"})["M.ice"]
    assert "underscore" not in plain
    for number, text in enumerate(
        (
            "module: M_1\n",
            "module: M\ntypes: {A: {struct: {b_1: int}}}\n",
            "module: M\ntypes: {E: {enum: [a_1]}}\n",
            "module: M\ninterfaces: {I: {methods: {f: {out: {b_1: int}}}}}\n",
            "module: M\nconstants: {b_1: {type: int, value: 1}}\n",
            "module: M\nimports: [Other]\ntypes: {A: {sequence: Other.T_1}}\n",
            "module: M\nimports: [Other]\ntypes: {A: {struct: {e: {type: Other.E, default: x_1}}}}\n",
        )
    ):
        other = "module: Other\ntypes: {T_1: {sequence: int}, E: {enum: [x_1]}}\n"
        files = texts(tmp_path / str(number), {"M.idsl.yaml": text, "Other.idsl.yaml": other})
        assert '[["underscore"]]\n' in files["M.ice"]


def test_a_guard_is_no_identifier(tmp_path: Path) -> None:
    text = texts(tmp_path, {"my-map.v2.idsl.yaml": "module: M\n"})["my-map.v2.ice"]
    assert text.splitlines()[1:3] == ["#ifndef ROBOCOMPMY_MAP_V2_ICE_", "#define ROBOCOMPMY_MAP_V2_ICE_"]


def test_slice_has_no_legacy_names(tmp_path: Path) -> None:
    lines = body(tmp_path, "interfaces: {I: {methods: {f: , f_2: {in: {a: int}, x-legacy-name: f}}}}\n")
    assert "    void f_2(int a);" in lines


def test_keys_of_other_tools_are_no_names(tmp_path: Path) -> None:
    text = (
        "x-a: 1\nconstants: {x-b: 1}\nexceptions: {x-g: 1}\n"
        "types: {x-c: 1, S: {x-d: 1, struct: {x-e: 1, a: int}}, E: {enum: {x-f: 1, a: 2}}}\n"
        "interfaces: {x-h: 1, I: {x-i: 1, methods: {x-j: 1, f: {x-k: 1, in: {x-l: 1, a: int}}}}}\n"
    )
    lines = [line for line in body(tmp_path, text) if line.strip(" {};")]
    assert lines == ["  struct S", "    int a;", "  enum E { a = 2 };", "  interface I", "    void f(int a);"]


def test_the_order_of_a_cyclic_module_terminates() -> None:
    """The emitter is never called for such a module, but must not hang."""
    from robocomp_yaml.link.program import LinkedModule
    from robocomp_yaml.model.interface import Member, TypeRef

    knot = (Struct("A", (Member("b", TypeRef("B")),)), Struct("B", (Member("a", TypeRef("A")),)))
    assert [d.name for d in target.in_order(LinkedModule(Module("M", "M.idsl.yaml", types=knot)))] == ["B", "A"]
