"""Random legacy files: the document says what the file said, and nothing makes the migrator stumble."""

from __future__ import annotations

import tempfile
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from robocomp_yaml.legacy import document
from robocomp_yaml.legacy.convert import Converted, convert
from robocomp_yaml.legacy.draft import ConfigDraft
from robocomp_yaml.legacy.ledger import LedgerEntry
from robocomp_yaml.legacy.sources import LegacyFile
from robocomp_yaml.model import build_component, build_interface, located
from robocomp_yaml.model.component import Component, Gui, Language, Use
from robocomp_yaml.model.interface import (
    BASIC_TYPES,
    Enum,
    Enumerator,
    ExceptionType,
    Import,
    Interface,
    Map,
    Member,
    Method,
    Module,
    Sequence,
    Struct,
    TypeRef,
)
from robocomp_yaml.source import schema
from robocomp_yaml.source.tree import Mapping, Scalar, parse
from robocomp_yaml.source.yaml_text import text_of

KEYWORDS = {
    "module", "struct", "enum", "exception", "sequence", "dictionary", "interface", "const", "class", "local", "void",
    "idempotent", "out", "throws", "extends", "implements", "optional", "import", "Object", "LocalObject", "Value",
    *BASIC_TYPES, "component", "communications", "requires", "publishes", "subscribesto", "language", "gui", "options",
    "statemachine", "useqt", "worker", "robocompclasses", "robocompmodules", "visual", "ice", "ros",
}  # fmt: skip
NAMES = st.one_of(
    st.sampled_from(["on", "yes", "No", "null", "true", "y", "Null", "e1", "_1e3", "inf", "nan", "x"]),
    st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,8}", fullmatch=True),
).filter(lambda name: name.lower() not in KEYWORDS and name not in KEYWORDS)
BLANKS = st.sampled_from([" ", "\n", "\t", " \n\t ", " // a: b # c\n", "/* [x, {y}] */", "\r\n", " /* \n */ "])
SAID = ["Says", "it.", "a: b", "# c", "- d", "{e}", "[f,", "'g'", '"h"', "%", "@", "é", "10"]
WORDS = st.lists(st.sampled_from(SAID), min_size=1, max_size=6).map(" ".join)


def unique(size: int) -> SearchStrategy[list[str]]:
    return st.lists(NAMES, max_size=size, unique_by=str.lower)


@st.composite
def types(draw: st.DrawFn) -> TypeRef:
    if draw(st.booleans()):
        return TypeRef(draw(st.sampled_from(BASIC_TYPES)))
    return TypeRef(".".join(draw(st.lists(NAMES, min_size=1, max_size=2))))


@st.composite
def members(draw: st.DrawFn) -> tuple[Member, ...]:
    return tuple(Member(name, draw(types()), draw(st.just("") | WORDS)) for name in draw(unique(7)))


@st.composite
def methods(draw: st.DrawFn, name: str) -> Method:
    names = draw(unique(5))
    split = draw(st.integers(0, len(names)))
    parameters = [Member(n, draw(types())) for n in names]
    thrown = tuple(draw(st.lists(types().filter(lambda ref: not ref.is_basic), max_size=2)))
    returns = draw(st.none() | types())
    return Method(name, tuple(parameters[:split]), tuple(parameters[split:]), returns, thrown, draw(st.booleans()),
                  draw(st.just("") | WORDS))  # fmt: skip


@st.composite
def modules(draw: st.DrawFn) -> Module:
    made: dict[str, list] = {"types": [], "exceptions": [], "interfaces": []}  # type: ignore[type-arg]
    for name in draw(unique(6)):
        doc = draw(st.just("") | WORDS)
        kind = draw(st.sampled_from(["struct", "enum", "sequence", "map", "exception", "interface"]))
        if kind == "exception":
            made["exceptions"].append(ExceptionType(name, draw(members()), doc))
        elif kind == "interface":
            declared = tuple(draw(methods(method)) for method in draw(unique(4)))
            made["interfaces"].append(Interface(name, declared, doc=doc))
        elif kind == "struct":
            made["types"].append(Struct(name, draw(members()), doc))
        elif kind == "enum":
            values = draw(st.booleans())
            made["types"].append(Enum(name, tuple(
                Enumerator(n, draw(st.integers(0, 9)) if values else None) for n in draw(unique(5))
            ), doc))  # fmt: skip
        elif kind == "sequence":
            made["types"].append(Sequence(name, draw(types()), doc))
        else:
            made["types"].append(Map(name, draw(types()), draw(types()), doc))
    imports = tuple(Import(name) for name in draw(st.lists(NAMES, max_size=3, unique=True)))
    return Module(draw(NAMES), "X.idsl.yaml", imports, types=tuple(made["types"]),
                  exceptions=tuple(made["exceptions"]), interfaces=tuple(made["interfaces"]),
                  doc=draw(st.just("") | WORDS))  # fmt: skip


class Text:
    """A legacy file's text from tokens, with any blanks between them, and comments where they change nothing."""

    def __init__(self, draw: st.DrawFn) -> None:
        self.draw, self.parts = draw, list[str]()

    def put(self, *tokens: str) -> None:
        for token in tokens:
            self.parts += [token, " "]

    def doc(self, doc: str) -> None:
        if doc:
            self.parts.append(f"\n/// {doc}\n")

    def space(self) -> None:
        self.parts.append(self.draw(BLANKS))

    def type(self, ref: TypeRef | None) -> None:
        self.put(ref.text.replace(".", "::") if ref else "void")


def idsl_text(draw: st.DrawFn, module: Module) -> str:
    out = Text(draw)
    for imported in module.imports:
        out.put("import", f'"{draw(st.sampled_from(["", "/a/b/", "../"]))}{imported.text}.idsl"', ";")
    out.doc(module.doc)
    out.put("module", module.name, "{")
    definitions = [*module.types, *module.exceptions, *module.interfaces]
    for definition in definitions:
        out.space()
        out.doc(definition.doc)
        _definition(out, definition)
    out.put("}", ";")
    out.space()
    return "".join(out.parts)


def _definition(out: Text, definition: object) -> None:
    if isinstance(definition, Struct | ExceptionType):
        out.put("struct" if isinstance(definition, Struct) else "exception", definition.name, "{")
        for member in definition.members:
            out.doc(member.doc)
            out.type(member.type)
            out.put(member.name, ";")
        out.put("}", ";")
    elif isinstance(definition, Enum):
        out.put("enum", definition.name, "{")
        for number, enumerator in enumerate(definition.enumerators):
            out.put(*([","] if number else []), enumerator.name)
            out.put(*([] if enumerator.value is None else ["=", str(enumerator.value)]))
        out.put("}", ";")
    elif isinstance(definition, Sequence):
        out.put("sequence", "<")
        out.type(definition.element)
        out.put(">", definition.name, ";")
    elif isinstance(definition, Map):
        out.put("dictionary", "<")
        out.type(definition.key)
        out.put(",")
        out.type(definition.value)
        out.put(">", definition.name, ";")
    elif isinstance(definition, Interface):
        out.put("interface", definition.name, "{")
        for method in definition.methods:
            _method(out, method)
        out.put("}", ";")


def _method(out: Text, method: Method) -> None:
    out.space()
    out.doc(method.doc)
    out.put(*(["idempotent"] if method.idempotent else []))
    out.type(method.returns)
    out.put(method.name, "(")
    for number, (direction, parameter) in enumerate(
        [("", p) for p in method.inputs] + [("out", p) for p in method.outputs]
    ):
        out.put(*([","] if number else []), *([direction] if direction else []))
        out.type(parameter.type)
        out.put(parameter.name)
    out.put(")")
    for number, thrown in enumerate(method.throws):
        out.put("throws" if number == 0 else ",")
        out.type(thrown)
    out.put(";")


def _converted(name: str, text: str | bytes) -> tuple[Converted, str]:
    """What becomes of a text, and the document."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        result = convert(str(path))
    draft = result.draft
    if draft is None or isinstance(draft, ConfigDraft):  # a config's document is made with those of its component
        return result, ""
    return result, document.text(draft.document, draft.around)


def _tree(kind: str, text: str) -> Mapping:
    tree, diagnostics = parse("X.yaml", text)
    assert isinstance(tree, Mapping), (diagnostics, text)
    assert schema.validate(kind, tree) == [], text
    return tree


@settings(deadline=None)
@given(st.data(), modules())
def test_an_interface_file_says_the_same_as_its_document(data: st.DataObject, module: Module) -> None:
    source = idsl_text(data.draw, module)
    result, text = _converted("X.idsl", source)
    assert not result.diagnostics, source
    assert build_interface.build(_tree("idsl", text), "X.idsl.yaml") == module, text
    assert all(len(line) <= 120 for line in text.splitlines() if "#" not in line and "doc:" not in line)


@st.composite
def components(draw: st.DrawFn) -> Component:
    def ports() -> tuple[Use, ...]:
        return tuple(Use(name, name) for name in draw(unique(4)))

    return Component(
        draw(NAMES), "c.cdsl.yaml", Language(draw(st.sampled_from(["python", "cpp"]))),
        tuple(Import(name) for name in draw(st.lists(NAMES, max_size=3, unique=True))),
        ports(), ports(), ports(), ports(),
        gui=draw(st.none() | st.sampled_from(["QWidget", "QDialog"]).map(lambda base: Gui("qt", base))),
        options=tuple(map(located.Text, draw(st.lists(st.sampled_from(["dsr", "agmagent"]), max_size=2, unique=True)))),
    )  # fmt: skip


def cdsl_text(draw: st.DrawFn, component: Component) -> str:
    out = Text(draw)
    for imported in component.imports:
        out.put("import", f'"{imported.text}.idsl"', ";")
    out.put("Component", component.name, "{")
    lists = {
        "implements": component.implements, "requires": component.requires, "publishes": component.publishes,
        "subscribesTo": component.subscribes,
    }  # fmt: skip
    inner = [f"{key} {', '.join(use.name for use in uses)};" for key, uses in lists.items() if uses]
    lists_text = " ".join(draw(st.permutations(inner)))
    clauses = [f"Communications {{ {lists_text} }};", f"language {component.language.name};"]
    if component.gui:
        clauses.append(f"gui Qt({component.gui.base});")
    if component.options:
        clauses.append(f"options {', '.join(option.text for option in component.options)};")
    for clause in draw(st.permutations(clauses)):
        out.space()
        out.put(clause)
    out.put("}", ";")
    return "".join(out.parts)


@settings(deadline=None)
@given(st.data(), components())
def test_a_component_file_says_the_same_as_its_document(data: st.DataObject, component: Component) -> None:
    source = cdsl_text(data.draw, component)
    result, text = _converted("c.cdsl", source)
    assert not result.diagnostics, source
    assert build_component.build(_tree("cdsl", text), "c.cdsl.yaml") == component, text


SAMPLE = """import "A.idsl";
module M { /// d
 struct S { int a = 1; // t
 }; interface I { void f(out S s) throws E; }; };
"""
OTHERS = [*"{};,<>()\"'/*#\\\n\t\0é", "Component", "language", "//", "/*"]
PIECES = st.lists(st.sampled_from([*SAMPLE.split(" "), *OTHERS]))


@settings(deadline=None)
@given(
    st.sampled_from(["x.idsl", "x.ice", "x.cdsl", "x", "x.conf", "x.toml", "x.jcdsl", "x.pdsl", "x.pconf"]),
    PIECES.map(" ".join) | st.text() | st.binary(),
)
def test_nothing_makes_it_stumble_and_every_line_is_counted(name: str, text: str | bytes) -> None:
    result, written = _converted(name, text)
    assert result.refused == any(d.severity == "error" for d in result.diagnostics)
    entry = LedgerEntry(LegacyFile(result.path, "", ""), result, diagnostics=[*result.diagnostics])
    if result.source is not None:
        assert entry.lines().total() == result.source.lines
        for diagnostic in result.diagnostics:
            assert 1 <= diagnostic.span.line <= max(result.source.lines, 1)
            assert 1 <= diagnostic.span.column <= diagnostic.span.end_column
    if written:
        assert parse("X.yaml", written)[1] == [], written


@settings(deadline=None, max_examples=300)
@given(st.text(st.characters(exclude_categories=["Cs"])) | WORDS | st.from_regex(r"[-+.0-9xo_:~nultrefas]+\Z"))
def test_a_text_is_read_back_as_it_was(text: str) -> None:
    for wrapped in (
        f"a: {text_of(text)}\n",
        f"a: {{b: {text_of(text, in_flow=True)}, c: d}}\n",
        f"{text_of(text)}: 1\n",
    ):
        tree, diagnostics = parse("X.yaml", wrapped)
        assert isinstance(tree, Mapping), (wrapped, diagnostics)
        values = [key for key, _ in tree.items()] if wrapped.endswith(": 1\n") else [tree.get("a")]
        value = values[0].get("b") if isinstance(values[0], Mapping) else values[0]
        assert isinstance(value, Scalar) and value.lexeme == text and value.data == text, wrapped


@settings(deadline=None)
@given(st.lists(st.text(st.characters(exclude_categories=["Cs", "Cc"]), max_size=60), max_size=6).map("\n".join))
def test_a_long_text_is_read_back_but_for_blanks_around_it(doc: str) -> None:
    body = document.Map(block=True)
    body.put("doc", document.Doc(doc))
    tree, diagnostics = parse("X.yaml", document.text(body, document.Notes()))
    assert isinstance(tree, Mapping), diagnostics
    lines = [line.rstrip() for line in str(tree.data["doc"]).strip().split("\n")]  # type: ignore[index]
    assert lines == [line.rstrip() for line in doc.strip().split("\n")]
