"""Names in Slice, generated or written by hand, lead to the documents and back, at the exact text."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from in_memory import ROOT, analysed
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit import slice as slice_target
from robocomp_yaml.naming import names as kinds
from robocomp_yaml.naming.analysis import names_of
from robocomp_yaml.naming.in_slice import files_of_slice, meant_in_slice, names_in, places_in_slice

DOCUMENTS = {
    "rcyaml.yaml": "interfaces: [.]\n",
    "Color.idsl.yaml": (
        "module: RoboCompColor\ntypes:\n  Color: {enum: [red, green]}\n  Pose: {struct: {x: float}}\n"
        "constants: {LIMIT: {type: int, value: 3}, BEST: {type: Color, value: red}}\n"
    ),
    "Paint.idsl.yaml": (
        "module: RoboCompPaint\nimports: [Color]\ntypes:\n  Row: {sequence: Color.Color}\n"
        "  Named: {map: {key: string, value: Row}}\n"
        "  Pose: {struct: {where: Color.Pose, tint: {type: Color.Color, default: green}, x: {type: string, doc: 'x of {Pose}'}}}\n"
        "exceptions: {Dry: {struct: {who: string}}}\n"
        "interfaces:\n  Paint:\n    methods:\n"
        "      stroke: {in: {at: Pose, many: Named}, out: {left: Row}, returns: Color.Color, throws: [Dry]}\n"
        "      stop:\n        idempotent: true\n"
        "topics: {Painted: {methods: {stroke: {in: {at: Pose}}}}}\n"
    ),
}  # fmt: skip
KEYWORDS = (
    "module struct enum sequence dictionary const interface exception idempotent throws void out string float int include "
    "ifndef define endif underscore ice".split()
)  # fmt: skip


def test_each_name_in_generated_slice_means_that_of_the_document() -> None:
    analysis = analysed(DOCUMENTS)
    assert not analysis.diagnostics
    program, names = analysis.program, names_of(analysis)
    texts = {
        f"/slice/{slice_target.file_name(linked)}": slice_target.text(linked) for linked in program.modules.values()
    }
    for path, text in texts.items():
        plain = re.sub(
            r"/\*.*?\*/|//[^\n]*|^#.*?$", lambda match: " " * len(match[0]), text, flags=re.DOTALL | re.MULTILINE
        )
        for number, line in enumerate(plain.splitlines(), 1):
            for word in re.finditer(r"[A-Za-z_]\w*", line):
                if word[0] in KEYWORDS:
                    continue
                found = meant_in_slice(program, names, path, text, number, word.end() + 1)
                assert found is not None, (path, line, word)
                assert (found[0].column, found[0].end_column, found[1].name) == (
                    word.start() + 1,
                    word.end() + 1,
                    word[0],
                )
    for one in names.of_kinds(kinds.METHOD, kinds.EVENT, kinds.TYPE, kinds.MEMBER, kinds.ENUMERATOR, kinds.ARGUMENT):
        places = places_in_slice(program, names, one, texts.items())
        assert places, one
        for place in places:
            line = texts[place.file].splitlines()[place.line - 1]
            assert line[place.column - 1 : place.end_column - 1] == one.name
            assert meant_in_slice(program, names, place.file, texts[place.file], place.line, place.column) == (
                place,
                one,
            )


# A name between « and » means the name of the document with the path behind it.
BY_HAND = """\
// by hand: Pose 🤖 «not a name
#ifndef X
#include <«Color.ice»Color>
#  include "deep/down/«Color.ice»Color"
#include <Ice/Identity.ice>
[["cpp:include:list"]]
module «RoboCompPaint»RoboCompPaint {
  interface «Paint»RoboCompPaint.Paint;
  ["cpp:type:wide"] sequence<«RoboCompColor»RoboCompColor::«Color»RoboCompColor.Color> «Row»RoboCompPaint.Row;
  sequence < ::«RoboCompColor»RoboCompColor :: «Color»RoboCompColor.Color > «Row»RoboCompPaint.Row;
  dictionary<string, «Row»RoboCompPaint.Row> «Named»RoboCompPaint.Named;
  /* struct Pose { */ struct «Pose»RoboCompPaint.Pose
  { optional(1) «RoboCompColor»RoboCompColor::«Pose»RoboCompColor.Pose «where»RoboCompPaint.Pose.where; int a = 3; string «x»RoboCompPaint.Pose.x = "«Pose»"; }
  local interface «Paint»RoboCompPaint.Paint extends Other::Base, «Paint»RoboCompPaint.Paint {
    idempotent
    «RoboCompColor»RoboCompColor::«Color»RoboCompColor.Color
      «stroke»RoboCompPaint.Paint.stroke ( «Pose»RoboCompPaint.Pose «at»RoboCompPaint.Paint.stroke.at , out ["x"] «Row»RoboCompPaint.Row «left»RoboCompPaint.Paint.stroke.left ) throws «Dry»RoboCompPaint.Dry ;
    void \\«stop»RoboCompPaint.Paint.stop(); void unknown(«Pose»RoboCompPaint.Pose other, «Paint»RoboCompPaint.Paint* one, Paint
"""


def test_slice_by_hand() -> None:
    analysis = analysed(DOCUMENTS)
    program, names = analysis.program, names_of(analysis)
    modules = {linked.module.path: linked.module for linked in program.modules.values()}
    expected: list[tuple[str, str]] = []
    plain = ""
    for part in re.split(r"(«[^»\n]*»[\w.:]*)", BY_HAND):
        match = re.fullmatch(r"«([^»]*)»([\w.:]*?)(:*)", part)
        if match is None or not match[1]:
            plain += part
            continue
        at = (plain.count("\n") + 1, len(plain.rpartition("\n")[2]) + 1)
        plain += match[1] + match[3]
        if match[2]:
            expected.append((f"{at[0]}:{at[1]}", match[2]))
    found = []
    for word in names_in("/w/Other.ice", plain):
        meant = meant_in_slice(program, names, "/w/Other.ice", plain, word.span.line, word.span.column)
        if meant is not None:
            name = modules[meant[1].key[1]].stem if word.document else ".".join(
                (modules[meant[1].key[1]].name, *meant[1].key[2:])
            )  # fmt: skip
            found.append((f"{meant[0].line}:{meant[0].column}", name))
    assert found == expected


@pytest.mark.parametrize(
    "text", ["", "{", "}}}}", "module", "module {", "module A { struct", "enum E { a, , = }", "()(;", "/*", '"', "::"]
)
def test_broken_slice_is_read_as_far_as_it_goes(text: str) -> None:
    names_in("/a.ice", text)
    assert all(isinstance(one.span, Span) for one in names_in("/a.ice", f"module A {{ {text} ; }}"))


def test_of_two_documents_with_a_module_the_one_that_is_called_like_the_file_counts() -> None:
    analysis = analysed({"A.idsl.yaml": "module: M\ntypes: {T: {struct: {a: int}}}\n",
                         "B.idsl.yaml": "module: M\ntypes: {T: {struct: {a: int}}}\n"})  # fmt: skip
    names = names_of(analysis)
    for stem in ("A", "B"):
        found = meant_in_slice(analysis.program, names, f"/s/{stem}.ice", "module M { struct T { int a; } }", 1, 19)
        assert found is not None and found[1].key == (kinds.TYPE, f"{ROOT}/{stem}.idsl.yaml", "T")


def test_files_of_slice(tmp_path: Path) -> None:
    for name in ("a.ice", "slice/b.ice", "generated/c.ice", ".hidden/d.ice", "e.ice.txt", "build/out/f.ice"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    found = [Path(path).name for path in files_of_slice(str(tmp_path), [str(tmp_path / "build/out")])]
    assert found == ["a.ice", "f.ice", "b.ice"]
    assert [Path(path).name for path in files_of_slice(str(tmp_path / "x.idsl.yaml"), [])] == ["a.ice"]
