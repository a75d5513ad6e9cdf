"""What converters return: a type for each kind of legacy file, with what a run needs to write its document; and what
converters share."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator
from typing import Any

import msgspec
from lark import Token, Tree

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.legacy.comments import PlacedComments
from robocomp_yaml.legacy.document import DocumentEntry, List, Map, Notes, ReferredName, Value
from robocomp_yaml.legacy.grammar import Parsed, token
from robocomp_yaml.legacy.networks.node import NetworkDraft, NetworkNode, safe_name
from robocomp_yaml.legacy.reading import SourceText
from robocomp_yaml.legacy.rules import Rules
from robocomp_yaml.legacy.settings.entries import ConfigSettings
from robocomp_yaml.link.options import meanings


class ImportDraft(msgspec.Struct, frozen=True):
    """An import as the file spells it. `entry` is the document's entry that gets the resolved name. `is_added`: an
    option of the component adds it, so that the document states it only under another name."""

    path: str
    span: Span
    entry: DocumentEntry
    is_added: bool = False

    @property
    def stem(self) -> str:
        return base_name(self.path)


class Reference(msgspec.Struct, frozen=True):
    """A reference of a module to a type. `module` is '' for a type of the same module; `written` is the name in the
    document."""

    module: str
    name: str
    written: ReferredName
    span: Span


class ModuleNames(msgspec.Struct):
    """What a module defines and refers to, so that unknown references can be reported."""

    name: str
    defined: set[str] = set()
    references: list[Reference] = []


class NamedMachine(msgspec.Struct, frozen=True):
    """The state machine of a component: its path as the file spells it. `entry` is the document's entry that gets the
    path of the SCXML file."""

    path: str
    span: Span
    entry: DocumentEntry

    @property
    def document(self) -> str:
        """The path of the SCXML file."""
        return re.sub(r"\.smdsl$", ".scxml", self.path, flags=re.IGNORECASE)


class _Document(msgspec.Struct, frozen=True):
    """A document as far as one file defines it, and the comments around it."""

    document: Map
    around: Notes


class ModuleDraft(_Document, frozen=True):
    """The document of an interface file, with imports that are not resolved yet."""

    imports: tuple[ImportDraft, ...]
    names: ModuleNames


class ComponentDraft(_Document, frozen=True):
    """The document of a component, with imports and a state machine that are not resolved yet."""

    imports: tuple[ImportDraft, ...]
    machine: NamedMachine | None = None


class ParametersDraft(_Document, frozen=True):
    """The document of a file that declares parameters, without the path of its component."""


class ValuesDraft(_Document, frozen=True):
    """The document of values for declared parameters, without the path of the declaration."""


class ConfigDraft(msgspec.Struct, frozen=True):
    """The settings of a config. All configs of a component are converted to documents together."""

    settings: ConfigSettings
    around: Notes


class DeploymentDraft(msgspec.Struct, frozen=True):
    """The network of a manager or launcher. It is converted when the components of the run are known."""

    network: NetworkDraft
    around: Notes


class MachineDraft(msgspec.Struct, frozen=True):
    """A state machine as SCXML text."""

    text: str


FileDraft = ModuleDraft | ComponentDraft | ParametersDraft | ValuesDraft | ConfigDraft | DeploymentDraft | MachineDraft


class Reader(msgspec.Struct, eq=False):
    """What converters share: the file, its rules, the comments by construct, and the diagnostics."""

    source: SourceText
    rules: Rules
    parsed: Parsed
    placed: PlacedComments
    diagnostics: list[Diagnostic] = []

    @property
    def tree(self) -> Tree[Token]:
        """The parsed tree. Only files that were parsed are converted."""
        assert self.parsed.tree is not None
        return self.parsed.tree

    def span(self, node: Tree[Token] | Token) -> Span:
        """Return the location of a construct or a token."""
        if isinstance(node, Token):
            return self.source.span(node.start_pos or 0, node.end_pos or 0)
        return self.source.span(node.meta.start_pos, node.meta.end_pos)

    def notes(self, tree: Tree[Token]) -> Notes:
        """Return the comments of a construct."""
        return self.placed.of(tree)

    def name(self, tree: Tree[Token]) -> str:
        """Return the name of a construct, '' where it has none."""
        found = token(tree, "NAME")
        return plain(found) if found is not None else ""

    def named(self, constructs: Iterable[Tree[Token]]) -> Iterator[tuple[str, Tree[Token]]]:
        """Yield constructs with their names. Report those that repeat a name, and omit them."""
        seen: set[str] = set()
        for construct in constructs:
            name = self.name(construct)
            if name in seen:
                self.repaired("repeated", construct, name)
            else:
                seen.add(name)
                yield name, construct

    def report(self, code: Code, at: Tree[Token] | Token, **facts: Any) -> None:
        """Report a diagnostic at the location of a construct or a token."""
        self.diagnostics.append(code.at(self.span(at), **facts))

    def repaired(self, repair: str, node: Tree[Token] | Token, text: str = "", **facts: str) -> None:
        """Report a fault that has one possible meaning, in the words of the rules' `repairs`."""
        what = self.rules.repairs[repair].format(text=text, **facts)
        self.report(codes.REPAIRED, node, what=what)

    def refused(self, refusal: str, node: Tree[Token] | Token, text: str = "", **facts: str) -> None:
        """Report what cannot be converted, in the words of the rules' `refusals`."""
        reason = self.rules.refusals[refusal]
        self.report(codes.REFUSED, node, reason=reason.format(text=text, **facts) if text else reason)

    def lost(self, loss: str, node: Tree[Token] | Token, text: str = "", **facts: str) -> None:
        """Report what no document contains, in the words of the rules' `losses`."""
        what = self.rules.losses[loss].format(text=text, **facts)
        self.report(codes.LOST, node, what=what)

    def word(self, what: str, text: str, at: Tree[Token] | Token) -> str:
        """Return the canonical spelling of a word; report an unknown word."""
        known = self.rules.values[what]
        if text.lower() not in known:
            hint = did_you_mean(text, known, otherwise="write " + " or ".join(dict.fromkeys(known.values())))
            self.report(codes.UNKNOWN_VALUE, at, what=what, value=text, hint=hint)
        return known.get(text.lower(), text)

    def gui(self, words: list[str], at: list[Tree[Token] | Token]) -> Map:
        """Return the `gui:` of a toolkit and a base class; `at` has the location of each."""
        toolkit = self.word("toolkit", words[0], at[0])
        base = self.word("base", words[1], at[1]) if words[1:] else self.rules.defaults["base"]
        return Map.of({"toolkit": toolkit, "base": base})

    def port(
        self, interface: str, used: Collection[str], declared: Collection[str], ros: Tree[Token] | None,
        *, from_0: bool = False,
    ) -> Value:  # fmt: skip
        """Return an entry of a list of ports. A further port of the same interface has a number behind its name, and if
        they are counted `from_0`, the first one, too. `ros` is the node that marks the port as one of ROS."""
        name, number = f"{interface}0" if from_0 else interface, 0
        while name in used or (number and name in declared):
            number += 1
            name = f"{interface}{number}"
        if ros is not None:
            self.report(codes.MIDDLEWARE, ros, name=interface)
            return Map.of({name: Map.of({"interface": interface, "x-middleware": "ros"})})
        return interface if name == interface else Map.of({name: interface})

    def doc(self, tree: Tree[Token], *names: str) -> str:
        """Return the doc comments of a construct as Markdown, without the markup that only repeats its name."""
        lines = self.notes(tree).doc
        if not lines:
            return ""
        drop = self.rules.doc.drop
        # Such markup is rare: test for any name first, which needs one pattern only.
        if any(re.match(drop.replace("{name}", "(?:.*)"), line.strip()) for line in lines):
            own = "|".join(re.escape(name) for name in names if name)
            lines = [line for line in lines if not re.match(drop.replace("{name}", f"(?:{own})"), line.strip())]
        text = re.sub(self.rules.doc.strip, "", "\n".join(lines).replace("\t", " "), flags=re.MULTILINE)
        return trimmed(text)

    def imports(self, nodes: list[Tree[Token]]) -> tuple[List, list[ImportDraft]]:
        """Return the list under `imports:`, each file once, and its drafts."""
        listed, drafts = List(), list[ImportDraft]()
        for node in nodes:
            literal = next(child for child in node.children if isinstance(child, Token))
            path = re.sub(r'^[^"<]*["<]|[">]$', "", str(literal)).strip()
            if not base_name(path):
                self.report(codes.SYNTAX, literal, problem="this import has no file name", hint="")
            elif any(known.stem == base_name(path) for known in drafts):
                self.repaired("lenient_duplicate_import", literal, base_name(path))
                drafts[-1].entry.notes.tail += [*self.notes(node).head, *self.notes(node).tail]
            else:
                entry = listed.put(base_name(path), self.notes(node))
                drafts.append(ImportDraft(path, self.span(literal), entry))
        return listed, drafts


def named_node(
    reader: Reader, network: NetworkDraft, name: str, at: Tree[Token] | Token, notes: Notes, whole: Tree[Token]
) -> NetworkNode:
    """Add a node to a network. `at` is the location of its name, `whole` that of its definition. Managers
    accept several nodes of one name: a later one gets a name of its own, and dependences mean the first one."""
    node = NetworkNode(name, safe_name(name, [known.name for known in network.nodes]), reader.span(at), notes=notes)
    if not name.strip():
        reader.refused("unnamed", whole)
    elif node.name != name:
        is_taken = safe_name(name) == name or any(name == known.alias for known in network.nodes)
        reader.repaired("same_name" if is_taken else "name", at, name, name=node.name)
    network.nodes.append(node)
    return node


class ComponentBuilder:
    """Builds the document of a component key by key, for all formats."""

    def __init__(self, reader: Reader) -> None:
        self.reader = reader
        self.entries: dict[str, DocumentEntry] = {}
        self.machine: NamedMachine | None = None
        self.added: list[ImportDraft] = []

    def add_option(self, name: str, at: Tree[Token] | Token) -> None:
        """Import what an option adds to the component."""
        meaning = meanings().get(name)
        for stem in meaning.imports if meaning is not None else ():
            self.added.append(ImportDraft(stem, self.reader.span(at), DocumentEntry("", stem), is_added=True))

    def put(self, key: str, value: Value, notes: Notes | None = None) -> DocumentEntry:
        self.entries[key] = DocumentEntry(key, value, notes or Notes())
        return self.entries[key]

    def put_machine(self, path: str, at: Tree[Token] | Token, notes: Notes | None = None) -> None:
        entry = self.put("statemachine", path, notes)
        self.machine = NamedMachine(path, self.reader.span(at), entry)
        entry.value = self.machine.document

    def draft(self, at: Tree[Token] | Token, imports: Iterable[ImportDraft], around: Notes) -> ComponentDraft:
        """Return the document: the keys in the order of the rules, then all others. `at` is the location of the
        component's name."""
        if "language" not in self.entries:
            self.reader.report(codes.NO_LANGUAGE, at, name=self.entries["component"].value)
        entries = {key: self.entries[key] for key in self.reader.rules.order if key in self.entries} | self.entries
        written = tuple(imports)
        known = {each.stem.lower() for each in written}
        added = {each.stem: each for each in self.added if each.stem.lower() not in known}
        every = (*written, *added.values())
        return ComponentDraft(Map([*entries.values()], block=True), around, every, self.machine)


def plain(name: Token) -> str:
    """Return an identifier without the '\\' with which Slice escapes keywords."""
    return str(name).lstrip("\\")


def base_name(path: str) -> str:
    """Return `X` for `/a/b/X.idsl`, `X.ice` and `X`."""
    return re.sub(r"\.(?:idsl|ice)$", "", re.split(r"[/\\]", path)[-1], flags=re.IGNORECASE)


def trimmed(text: str) -> str:
    """Strip blank lines around a text, trailing blanks of each line, and the indentation of the first line."""
    lines = [line.rstrip() for line in text.split("\n")]
    while lines and not lines[0]:
        del lines[0]
    return "\n".join([lines[0].lstrip(), *lines[1:]]).rstrip() if lines else ""
