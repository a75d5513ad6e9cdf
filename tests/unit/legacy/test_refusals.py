"""Broken legacy files with all their diagnostics: code, location, message."""

from __future__ import annotations

from pathlib import Path

import pytest

from robocomp_yaml.legacy.convert import convert

WITHOUT_ACCENTS = "a name consists of the letters A to Z without accents, digits and underscores: for example"

IDSL = [
    ("module A {\n struct S { int a int b; };\n};", ["RC5003 2:17 a ';' is missing after 'a'"]),
    ("module A { interface I {\n void f()\n void g();\n}; };", ["RC5003 2:9 a ';' is missing after ')'"]),
    ("module A { exception E { string what }; };", ["RC5003 1:36 a ';' is missing after 'what'"]),
    ("module A {\n struct S {\n int a;\n interface I {\n void f();\n };\n};",
     ["RC5003 4:2 'interface' is not allowed here (a '}' is probably missing before it)"]),
    ("module A {\n struct S { int a; };\n", ["RC5003 2:21 a '}' is missing: the file ends inside of this block"]),
    ("module A { interfacee I { void f(); };\n sturct S { int a; }; };",
     ["RC5003 1:12 'interfacee' is not allowed here (did you mean 'interface'?)",
      "RC5003 2:2 'sturct' is not allowed here (did you mean 'struct'?)"]),
    ("modul A { };",
     ["RC5003 1:1 expected the end of the file, '#include', 'import' or 'module', found 'modul' "
      "(did you mean 'module'?)"]),
    ("module { };", ["RC5003 1:8 expected a name after 'module', found '{'"]),
    ("moduleA { };",
     ["RC5003 1:1 expected the end of the file, '#include', 'import' or 'module', found 'moduleA' "
      "(did you mean 'module'?)"]),
    ("module A { interface I { void f(int a int b); }; };", ["RC5003 1:39 expected ')' or ',' after 'a', found 'int'"]),
    ("module A { struct S { int; }; enum E { a b }; interface I { f(); void g(out); }; };",
     ["RC5003 1:26 expected a name after 'int', found ';'", "RC5003 1:42 expected ',', '=' or '}' after 'a', found 'b'",
      "RC5003 1:62 expected a name after 'f', found '('",
      "RC5003 1:76 expected a name, a type, 'dictionary' or 'sequence' after 'out', found ')'"]),
    ("module A { /* hello\n };", ["RC5003 1:12 this comment is not closed"]),
    ('import "X.idsl;\nmodule A { };', ["RC5003 1:8 this text in quotes is not closed"]),
    ("import X;\nmodule A { };", ["RC5003 1:8 expected a text in double quotes after 'import', found 'X'"]),
    ('import "";\nmodule A { };', ["RC5003 1:8 this import has no file name"]),
    ("module A { struct S { int a; }; }; };",
     ["RC5003 1:36 expected the end of the file, '#include', 'import' or 'module' after ';', found '}'"]),
    ("module A { };\nnvidia",
     ["RC5003 2:1 expected the end of the file, '#include', 'import' or 'module' after ';', found 'nvidia'"]),
    ("module A { struct S { int a@; }; };", ["RC5003 1:28 '@' is not allowed here"]),
    ("module A-B { };", ["RC5003 1:9 '-' is not allowed here"]),
    ("module ../A { };", ["RC5003 1:8 '.' is not allowed here"]),
    ("module A { interface I { void f() throws; }; };", ["RC5003 1:41 expected a name after 'throws', found ';'"]),
    ("module A { dictionary<string> D; };", ["RC5003 1:29 expected ',' after 'string', found '>'"]),
    ("module A { enum E { 1, 2 }; };", ["RC5003 1:21 expected a name or '}' after '{', found '1'"]),
    ("module A { class C extends B { int a; void f(); }; };", ["RC5004 1:12 IDSL has no classes; use a struct"]),
    ("module A { local interface L { Object* f(); }; };", ["RC5004 1:12 IDSL has no local definitions"]),
    ("module A { interface I extends J, K { }; };",
     ["RC5004 1:24 IDSL has no inheritance of interfaces and exceptions; repeat what they inherit"]),
    ("module A { module B { }; };",
     ["RC5004 1:12 IDSL has no nested modules; move this one to a separate file"]),
    ("module A { };\nmodule B { };", ["RC5004 2:8 an IDSL file has one module; move this one to a separate file"]),
    ("module A { struct S { A::B::C x; }; };",
     ["RC5004 1:23 a type of another module is named Module::Type, without further levels"]),
    ("module A { struct S { sequence<int> x; }; };",
     ["RC5004 1:23 IDSL has no anonymous sequences and dictionaries; define a named one before"]),
    ("module A { struct S { optional(1) int a; }; };", ["RC5004 1:23 IDSL has no optional members and parameters"]),
    ("module A { interface I { I* f(); Object g(); }; };",
     ["RC5004 1:26 IDSL has no proxies as values", "RC5004 1:34 IDSL has no classes, and no type 'Object'"]),
    ('module A {\n#include "X.ice"\n};', ["RC5004 2:1 an import must be before the module"]),
    ("module A { struct S { int x; int x; }; struct S { int y; }; };",
     ["RC5013 1:34 'x' is defined a second time", "RC5013 1:47 'S' is defined a second time"]),
    ("module A { enum E { a, b, a }; };", ["RC5013 1:27 'a' is defined a second time"]),
    ("module A { interface I { void f(int a, out int a); }; };", ["RC5013 1:48 'a' is defined a second time"]),
    ("module Señal { };", [f"RC5014 1:8 'Señal' is not a legal name ({WITHOUT_ACCENTS} 'Senal')"]),
    ("", ["RC5002 1:1 this file contains no text, and nothing to migrate"]),
    ("// only this\n", ["RC5002 1:1 this file contains only comments, and nothing to migrate"]),
    ('import "A.idsl";\n', ["RC5002 1:1 this file contains no module, and nothing to migrate"]),
]  # fmt: skip

CDSL = [
    ("Component A { Communications { consumes B; }; language python; };",
     ["RC5003 1:32 expected 'implements', 'publishes', 'requires', 'subscribesTo' or '}' after '{', found 'consumes'"]),
    ("Component A { xxx\n Communications { };\n aaa\n language cpp; };",
     ["RC5003 1:15 'xxx' is not allowed here", "RC5003 3:2 'aaa' is not allowed here"]),
    ("Component A { languaje cpp; };", ["RC5003 1:15 'languaje' is not allowed here (did you mean 'language'?)"]),
    ("Component A Communications { }; language cpp; };",
     ["RC5003 1:13 expected '{' after 'A', found 'Communications'"]),
    ("Component A { Communications { requires B; language cpp; };",
     ["RC5003 1:44 'language' is not allowed here (a '}' is probably missing before it)"]),
    ("Component A { language cpp;", ["RC5003 1:27 a '}' is missing: the file ends inside of this block"]),
    ("Component A { Communications { requires A B; implements ; }; language cpp; };",
     ["RC5003 1:43 expected '(', ',', ';' or '}' after 'A', found 'B'",
      "RC5003 1:57 expected a name after 'implements', found ';'"]),
    ("Component A { language cpp; };\nComponent B { language cpp; };",
     ["RC5003 2:13 expected the end of the file after 'B', found '{'"]),
    ("Component A { language Rust; };", ["RC5015 1:24 unknown language 'Rust' (write cpp or python)"]),
    ("Component A { language N++; };", ["RC5015 1:24 unknown language 'N++' (write cpp or python)"]),
    ("Component A { language cpp; gui Gtk(QFoo); };",
     ["RC5015 1:33 unknown toolkit 'Gtk' (write qt)",
      "RC5015 1:37 unknown base 'QFoo' (write QWidget or QMainWindow or QDialog)"]),
    ("Component A { Communications { }; };", ["RC5016 1:11 component A has no `language`"]),
    ("Component A { language python; language cpp; };", ["RC5013 1:32 'language' is defined a second time"]),
    ("Component Camión { language python; };",
     [f"RC5014 1:11 'Camión' is not a legal name ({WITHOUT_ACCENTS} 'Camion')"]),
    ("Component A/B { language python; };", ["RC5003 1:12 '/' is not allowed here"]),
]  # fmt: skip


def _said(path: Path, text: str) -> list[str]:
    path.write_text(text, encoding="utf-8")
    result = convert(str(path))
    assert result.refused == bool(result.diagnostics)
    return [
        f"{d.code} {d.span.line}:{d.span.column} {d.message}" + (f" ({d.hint})" if d.hint else "")
        for d in result.diagnostics
    ]


@pytest.mark.parametrize(("text", "said"), IDSL)
def test_interfaces(tmp_path: Path, text: str, said: list[str]) -> None:
    assert _said(tmp_path / "X.idsl", text) == said


@pytest.mark.parametrize(("text", "said"), CDSL)
def test_components(tmp_path: Path, text: str, said: list[str]) -> None:
    assert _said(tmp_path / "x.cdsl", text) == said


def test_the_unclosed_block_is_shown(tmp_path: Path) -> None:
    path = tmp_path / "X.idsl"
    path.write_text("module A {\n struct S {\n int a;\n", encoding="utf-8")
    (diagnostic,) = convert(str(path)).diagnostics
    assert [(r.message, r.span.line, r.span.column) for r in diagnostic.related] == [("the block starts here", 2, 11)]


def test_a_file_with_a_thousand_errors_ends(tmp_path: Path) -> None:
    path = tmp_path / "X.idsl"
    path.write_text("module A {\n" + " what is this;\n" * 1000 + "};\n", encoding="utf-8")
    assert len(convert(str(path)).diagnostics) == 20
