"""Names that are illegal in C++: what `check` reports for an interface, and what slice2cpp and g++ accept."""

from __future__ import annotations

import random
import re
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

from conftest import write_tree
from cpp_macros import FAMILIES, detected_globals, found, headers
from cpp_programs import needs_cpp
from robocomp_yaml.languages.cpp import globals as cpp_globals
from robocomp_yaml.languages.cpp import macros as cpp_macros

pytestmark = needs_cpp
Check = Callable[..., list[dict[str, Any]]]

TYPES = """\
types:
  Pose: {struct: {x: int}}
  Side: {enum: [left, right]}
  Path: {sequence: int}
  Names: {map: {key: int, value: string}}
exceptions:
  Lost: {struct: {where: int}}
"""
METHOD = "interfaces: {{Map: {{methods: {{{}}}}}}}\n"

# Every way in which a name may clash with a type, or with another name, in Ice's generated code.
PARAMETERS = [
    f"f: {{{given}}}"
    for one, name in (("Pose", "Pose"), ("Side", "Side"), ("Path", "Path"), ("Names", "Names"), ("int", "Pose"),
                      ("Side", "Path"))
    for given in (
        f"in: {{{name}: {one}, b: {name}}}", f"in: {{b: {name}, {name}: {one}}}",
        f"in: {{{name}: {one}}}, returns: {name}",
        f"in: {{{name}: {one}}}, out: {{b: {name}}}", f"in: {{a: {name}}}, out: {{{name}: {one}}}",
        f"out: {{{name}: {one}, b: {name}}}", f"out: {{b: {name}, {name}: {one}}}",
        f"out: {{{name}: {one}}}, returns: {name}",
        f"out: {{{name}: {one}, b: int}}", f"out: {{{name}: {one}}}, returns: int",
        f"in: {{a: {name}}}, out: {{{name}: int}}, returns: int",
    )
]  # fmt: skip
RESULTS = [
    "move: {out: {a: int}, returns: int}, MoveResult: ", "move: {out: {a: int, b: int}}, MoveResult: ",
    "move: {out: {a: int}}, MoveResult: ", "move: {returns: int}, MoveResult: ", "move: , moveAsync: ",
    "move: {out: {a: int}, returns: int}, moveResult: ", "move: {out: {returnValue: int}, returns: int}",
    "f: {in: {Lost: int}, throws: [Lost]}", "f: {in: {Map: int}}", "Pose: {returns: Pose}", "Lost: {throws: [Lost]}",
]  # fmt: skip
MEMBERS = [
    f"  {kind}{{{given}}}}}\n"
    for kind in ("S: {struct: ", "exceptions:  S: {struct: ")
    for name in ("Pose", "Side", "Path", "Names")
    for given in (f"{name}: {name}", f"{name}: {name}, b: {name}", f"b: {name}, {name}: {name}",
                  f"b: {name}, {name}: int", f"{name}: int, b: {name}", f"{name}: int", "S: int")
]  # fmt: skip


def documents() -> dict[str, str]:
    """A document for each name, by its stem."""
    texts = [TYPES + METHOD.format(methods) for methods in (*PARAMETERS, *RESULTS)]
    for member in MEMBERS:
        at = "exceptions:\n" if "exceptions:" in member else "types:\n"
        texts.append(TYPES.replace(at, at + member.replace("exceptions:  ", "")))
    return {f"D{number}": f"module: M{number}D\n{text}" for number, text in enumerate(texts)}


def refused(folder: Path, stems: list[str]) -> set[str]:
    """The stems whose C++ has errors. All are compiled together, because Ice's headers take long."""
    files = [f"{stem}.ice" for stem in stems]
    subprocess.run(["slice2cpp", "-I.", *files], cwd=folder, check=True)
    (folder / "headers").mkdir()
    source = [f"#include <{name}>\n" for name in headers(folder / "headers")]
    source += (f'#include "{stem}.cpp"\n' for stem in stems)
    (folder / "all.cpp").write_text("".join(source))
    command = ["g++", "-std=c++17", "-DICE_CPP11_MAPPING", "-fsyntax-only", "-fmax-errors=0", "-I.", "all.cpp"]
    said = subprocess.run(command, cwd=folder, capture_output=True, text=True).stderr
    return set(re.findall(r"(?:^|/)(\w+)\.(?:h|cpp):\d+:\d+: error:", said, re.MULTILINE)) & set(stems)


def test_names_of_types(tmp_path: Path, rcyaml: Callable[..., Any], diagnostics: Check) -> None:
    """`check` rejects what the compiler rejects, and nothing else."""
    texts = documents()
    component = f"component: C\nlanguage: cpp\nimports: [{', '.join(texts)}]\n"
    said = diagnostics({**{f"{stem}.idsl.yaml": text for stem, text in texts.items()}, "c.cdsl.yaml": component})
    assert {d["code"] for d in said} == {"RC1026"}
    ours = {str(d["file"]).removesuffix(".idsl.yaml") for d in said if d["severity"] == "error"}
    write_tree(tmp_path / "slice", {f"{stem}.idsl.yaml": text for stem, text in texts.items()})
    assert rcyaml("compile", str(tmp_path / "slice")).exit_code == 0
    theirs = refused(tmp_path / "slice" / "slice", list(texts))
    assert {stem: texts[stem] for stem in theirs - ours} == {}, "g++ refuses more"
    assert {stem: texts[stem][-120:] for stem in ours - theirs} == {}, "g++ takes it"
    assert 40 < len(theirs) < len(texts) - 40


def test_the_table_has_the_macros_of_this_machine() -> None:
    """`make macros` adds what is missing."""
    table = {"ALWAYS": cpp_macros.ALWAYS, "SINCE_20": cpp_macros.SINCE_20, "QT": cpp_macros.QT}
    known: set[str] = set()
    for name, macros in found().items():
        known = known | table[name] if name != "QT" else set(cpp_macros.EVER)
        assert sorted(macros - known) == [], f"{name} lacks these"
    assert cpp_macros.FAMILIES == FAMILIES


def test_the_table_has_what_is_in_no_namespace() -> None:
    """`make macros` adds what is missing."""
    names = detected_globals()
    assert sorted(names - cpp_globals.GLOBALS) == []
    assert {"time", "log", "index", "FILE", "int8_t"} <= names and "Time" not in cpp_globals.GLOBALS


# A macro with arguments is not expanded without a `(`, but is rejected too: how the component's own code uses the name
# is unknown.
POSITIONS = {
    "enumerator": "enum E {{ first, {} }};", "member": "struct S {{ int {}; }};",
    "exception": "exception {} {{ int a; }};",
    "member of an exception": "exception X {{ int {}; }};", "method": "interface I {{ void {}(int a); }};",
    "parameter": "interface I {{ int f(int {}); }};", "out": "interface I {{ int f(out int {}); }};",
    "struct": "struct {} {{ int a; }};", "sequence": "sequence<int> {};", "constant": "const int {} = 1;",
    "interface": "interface {} {{ }};", "module": "module {} {{ struct T {{ int a; }}; }};",
}  # fmt: skip
CALLED = ("exception", "member of an exception", "method")


def test_macros_in_every_position(tmp_path: Path) -> None:
    """A sample: each name has a dozen positions. Harmless names are between them."""
    plain = sorted(cpp_macros.ALWAYS - {"assert", "FD_SET", "offsetof"})
    words = ["EOF", "errno", "M_PI", *random.Random(7).sample([w for w in plain if not w.islower()], 2)]
    stems: dict[str, tuple[str, str]] = {}
    for word in [*words, "assert", "FD_SET", "harmless"]:
        for place, text in POSITIONS.items():
            stem = f"W{len(stems)}W"
            stems[stem] = (word, place)
            inside = text.format(word)
            module = inside if place == "module" else f"module M{stem} {{ {inside} }};"
            (tmp_path / f"{stem}.ice").write_text(f'[["underscore"]]\n{module}\n')
    theirs = {stems[stem] for stem in refused(tmp_path, list(stems))}
    for place in POSITIONS:
        refused_there = {word for word, where in theirs if where == place}
        assert set(words) <= refused_there | ({"errno"} if place == "module" else set()), place
        assert "harmless" not in refused_there, place
        assert {"assert", "FD_SET"} & refused_there == ({"assert", "FD_SET"} if place in CALLED else set()), place
