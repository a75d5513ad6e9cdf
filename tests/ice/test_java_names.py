"""Odd names: every name that IDSL and Slice accept becomes Java that compiles, runs and answers, or `check` rejects it."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from components import build
from java_programs import java_build, needs_java
from processes import Ports, Start
from robocomp_yaml.languages.java.checks import INSIDE, TYPES
from robocomp_yaml.languages.java.names import ICE_ESCAPES

# Words of Slice, which no document can use.
SLICE = set("boolean byte bool class const double enum extends false float implements int interface long object optional "
            "short string struct throws true void".split())  # fmt: skip
# Names that the run time, generated files, Ice's code or Java's libraries use.
OTHERS = """
    Boolean Comparable Data Deprecated Double Error Exception Exceptions Integer Iterable Kind List Live Log Main Map Math
    Member Named Optional Parameters Record Runtime Services Store System Table Thread Values Worker GenericWorker
    SpecificWorker communicator compute connect connections context current ex exports gate generated in0 initialize
    istr killYourSelf log mutex name opens ostr other parameters permits record requires result returnValue rhs root
    sealed serialVersionUID slice store transitive uses value values valueOf var with worker write read yield
    com java zeroc
""".split()
# For Slice, names that differ only in case are the same.
DISTINCT = sorted({name.lower(): name for name in sorted({*ICE_ESCAPES, *OTHERS})}.values())
NAMES = [name for name in DISTINCT if name not in SLICE]


@pytest.mark.skipif(
    shutil.which("slice2java") is None, reason="slice2java is not installed (Debian: zeroc-ice-compilers)"
)
def test_what_ice_escapes(tmp_path: Path) -> None:
    members = "".join(f"int \\{name};\n" for name in DISTINCT)
    (tmp_path / "K.ice").write_text(f"module M {{ struct S {{\n{members}}}; }};\n")
    subprocess.run(["slice2java", "K.ice"], cwd=tmp_path, check=True)
    found = set(re.findall(r"public int _(\w+);", (tmp_path / "M" / "S.java").read_text()))
    assert found == ICE_ESCAPES


def listed(kind: str) -> list[str]:
    """Names that this kind of definition may have."""
    return [name for name in NAMES if name not in INSIDE.get(kind, ())]


METHODS = "".join(
    f"      {name}: {{in: {{{name if name in listed('parameter') else 'x1'}: int, x: string}}, returns: string}}\n"
    for name in listed("method")
    if name != "public"  # as the interface is called
)
MODULES = ("System", "java", "slice", "package", "Parameters", "String1")
TYPE_NAMES = [name for name in NAMES if name not in TYPES and name not in ("Parameters", "Record")]
DOCUMENTS = {
    "Odd.idsl.yaml": f"""\
module: native
types:
  final: {{enum: [{", ".join(map(repr, listed("enumerator")))}]}}
  package: {{struct: {{{", ".join(f"{name}: int" for name in listed("member") if name not in ("package", "final", "slice"))}, side: final, text: {{type: string, default: "a \\\\ u0041 and \\" in it"}}}}}}
  synchronized: {{sequence: package}}
  strictfp: {{map: {{key: string, value: synchronized}}}}
  goto: {{sequence: strictfp}}
exceptions:
  assert: {{struct: {{super: package, stackTrace: string, message: int, cause: final}}}}
interfaces:
  public:
    methods:
      all: {{in: {{{", ".join(f"{name}: int" for name in listed("parameter"))}}}, returns: int}}
{METHODS}
  volatile:
    methods:
      given:
        in: {{log: final, slice: synchronized, worker: goto}}
        out: {{this: package, returnValue1: strictfp}}
        returns: final
        throws: [assert]
      many: {{out: {{a: goto, current: synchronized}}}}
topics:
  protected:
    methods:
      private: {{in: {{goto: package}}}}
""",
    **{
        f"{module}.idsl.yaml": f"module: {module}\nimports: [Odd]\ntypes:\n  thing: {{struct: {{of: native.package}}}}\n"
        for module in MODULES
    },
    "Types.idsl.yaml": "module: RoboCompTypes\ntypes:\n"
    + "".join(f"  {name}: {{struct: {{x: int, y: string}}}}\n" for name in TYPE_NAMES if name not in ICE_ESCAPES),
    "odd/odd.cdsl.yaml": f"""\
component: test
doc: |
  Odd, with a backslash \\u0041
  and */ more /* of it <b> @see
language: java
imports: [Odd, Types, {", ".join(MODULES)}]
implements: [public, volatile]
requires:
  - {{this: {{interface: public, absent: ignore}}}}
  - {{delete: {{interface: volatile, absent: ignore}}}}
publishes: [protected]
subscribes: [protected]
parameters: odd.pdsl.yaml
""",
    "odd/odd.pdsl.yaml": f"""\
types:
  String: {{struct: {{{", ".join(f"{name}: {{type: int, default: 1}}" for name in sorted({*NAMES, "int", "class", "of"}))}}}}}
  Override: {{enum: [{", ".join(map(repr, sorted({*NAMES, "class", "text", "of", "ordinal"})))}]}}
  List: {{struct: {{inner: {{list: String, default: []}}, named: {{map: Override, default: {{}}}}}}}}
parameters:
{"".join(f"  {name}: {{type: int, default: 1, editable: true}}" + chr(10) for name in sorted({*NAMES, "class", "store", "table"} - {"public", "volatile", "protected"}))}
  texts: {{list: String, default: [{{}}]}}
  way: {{type: Override, default: final}}
  deep: {{group: {{way: {{type: Override, optional: true}}, Values: {{group: {{x: {{type: float, default: 0.5}}}}}}}}}}
  of: {{list: List, optional: true}}
  odd-name: {{type: string, as: oddName, doc: "A \\u2028 \\\\u0041 */ <b> @x", default: "\\r\\n\\t\\"\\\\ \\u2028 é 𝄞 \\\\u0041"}}
""",
    "rcyaml.yaml": "lint: {RC1006: off}\n",  # words that are odd in Python
}


@pytest.mark.slow
@needs_java
def test_odd_names_compile_and_run(tmp_path: Path, start: Start, free_port: Ports, ice: Any) -> None:
    component = build(DOCUMENTS, tmp_path)["test"]
    java_build(component.root)
    endpoints = {f"{name}.Endpoints": f"tcp -h 127.0.0.1 -p {free_port()}" for name in ("public", "volatile")}
    here = {"thisProxy": f"public:{endpoints['public.Endpoints']}", "deleteProxy": "volatile:tcp -p 1"}
    manager = {"TopicManager.Proxy": "nobody:tcp -h 127.0.0.1 -p 1"}
    running = start(component.configure({**endpoints, **here, **manager}).command)
    running.wait_for("INFO test: waiting for TopicManager")
    proxy = ice.stringToProxy(here["thisProxy"])
    proxy.ice_ping()
    assert running.stop() == 0


Check = Callable[..., Any]


@pytest.mark.parametrize(
    ("types", "interfaces", "count"),
    [
        ({"S": {"struct": {"S": "int"}}}, {}, 1),
        ({"E": {"enum": ["a"]}, "S": {"struct": {"E": "int", "f": "E"}}}, {}, 1),
        ({"E": {"enum": ["a"]}, "S": {"struct": {"E": "E", "b": "int"}}}, {}, 0),
        ({"T": {"struct": {"a": "int"}}, "Ts": {"sequence": "T"}, "S": {"struct": {"T": "int", "Ts": "Ts"}}}, {}, 0),
        ({"S": {"struct": {"slice": "int", "o": "Other.P"}}}, {}, 1),
        ({"S": {"struct": {"slice": "int", "o": "int"}}}, {}, 0),
        ({"E": {"enum": ["a"]}}, {"I": {"methods": {"m": {"out": {"E": "int"}, "returns": "E"}}}}, 1),
        ({"E": {"enum": ["a"]}}, {"I": {"methods": {"m": {"in": {"E": "int"}, "returns": "E"}}}}, 0),
        ({"MResult": {"enum": ["a"]}}, {"I": {"methods": {"m": {"out": {"e": "MResult"}, "returns": "int"}}}}, 1),
    ],
)
def test_a_member_that_hides_a_type(
    rcyaml: Check, tmp_path: Path, types: dict[str, Any], interfaces: dict[str, Any], count: int
) -> None:
    module = {"module": "RoboCompOdd", "imports": ["Other"], "types": types, "interfaces": interfaces}
    (tmp_path / "Odd.idsl.yaml").write_text(json.dumps({key: value for key, value in module.items() if value}))
    (tmp_path / "Other.idsl.yaml").write_text("module: Other\ntypes: {P: {struct: {x: int}}}\n")
    (tmp_path / "c.cdsl.yaml").write_text("component: C\nlanguage: java\nimports: [Odd]\n")
    said = json.loads(rcyaml("check", "--format", "json").stdout)["diagnostics"]
    assert [one["code"] for one in said if one["severity"] == "error"] == ["RC2061"] * count, said


REFUSED = [("type", name) for name in sorted(TYPES)]
REFUSED += [(kind, name) for kind, names in INSIDE.items() for name in sorted(names)]


@pytest.mark.parametrize(("kind", "name"), REFUSED)
def test_what_java_cannot_have_is_rejected(rcyaml: Check, tmp_path: Path, kind: str, name: str) -> None:
    module = {
        "type": {"types": {name: {"struct": {"x": "int"}}}},
        "member": {"types": {"T": {"struct": {name: "int"}}}},
        "enumerator": {"types": {"T": {"enum": [name, "b"]}}},
        "method": {"interfaces": {"I": {"methods": {name: {"in": {"x": "int"}}}}}},
        "parameter": {"interfaces": {"I": {"methods": {"go": {"in": {name: "int"}}}}}},
    }[kind]
    for language, count in (("java", 1), ("python", 0)):
        (tmp_path / "Odd.idsl.yaml").write_text(json.dumps({"module": "RoboCompOdd", **module}))
        (tmp_path / "c.cdsl.yaml").write_text(f"component: C\nlanguage: {language}\nimports: [Odd]\n")
        said = json.loads(rcyaml("check", "--format", "json").stdout)["diagnostics"]
        assert [one["code"] for one in said].count("RC2061") == count, said


@pytest.mark.slow
@needs_java
def test_java_does_not_have_it(tmp_path: Path) -> None:
    """For each kind, the compilers decide: only names that they reject are rejected."""
    taken = []
    for kind, name in REFUSED:
        text = {
            "type": f"struct {name} {{ int a; string t; }}; enum E {{ p }}; interface {name}I {{ {name} go(E e, string t); }};"
            f" exception X {{ {name} n; E e; }};",
            "member": f"struct S {{ int {name}; string t; }}; struct T {{ string {name}; S s; }};",
            "enumerator": f"enum E {{ {name}, q }}; struct S {{ E a; string t; }};",
            "method": f"struct S {{ int a; }}; interface I {{ int {name}(S s); void go(); }};",
            "parameter": f"struct S {{ int a; }}; exception X {{ int b; }}; interface I {{ S go(S {name}) throws X; int at(out S {name}); }};",
        }[kind]
        folder = tmp_path / f"{kind}-{name}"
        folder.mkdir()
        (folder / "F.ice").write_text(f'[["java:package:slice"]]\nmodule M {{ {text} }};\n')
        subprocess.run(["slice2java", "F.ice"], cwd=folder, check=True)
        jars = ":".join(map(str, Path("/usr/share/java").glob("ice-3.7*.jar")))
        sources = list(map(str, folder.rglob("*.java")))
        if subprocess.run(["javac", "-nowarn", "-cp", jars, "-d", folder / "classes", *sources],
                          capture_output=True).returncode == 0:  # fmt: skip
            taken.append((kind, name))
    assert taken == []
