"""What a converter makes of one legacy file: for each kind of file a type of its own, with what a run still needs to
make a document of it."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable

import msgspec
from lark import Token, Tree

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


class ImportDraft(msgspec.Struct, frozen=True):
    """An import as the file spells it; `entry` is where its name goes."""

    path: str
    span: Span
    entry: DocumentEntry

    @property
    def stem(self) -> str:
        return base_name(self.path)


class Reference(msgspec.Struct, frozen=True):
    """A type that a module names: `module` is '' for one of its own. `written` is how the document names it."""

    module: str
    name: str
    written: ReferredName
    span: Span


class ModuleNames(msgspec.Struct):
    """What a module defines and refers to: enough to tell a reference that leads nowhere."""

    name: str
    defined: set[str] = set()
    references: list[Reference] = []


class NamedMachine(msgspec.Struct, frozen=True):
    """The state machine that a component names: its path as the file spells it; `entry` is where the new one goes."""

    path: str
    span: Span
    entry: DocumentEntry

    @property
    def document(self) -> str:
        """The path of what it becomes."""
        return re.sub(r"\.smdsl$", ".scxml", self.path, flags=re.IGNORECASE)


class _Document(msgspec.Struct, frozen=True):
    """A document, as far as its own file says it, and the comments around it."""

    document: Map
    around: Notes


class ModuleDraft(_Document, frozen=True):
    """Of an interface file: its document, but for what its imports will be called."""

    imports: tuple[ImportDraft, ...]
    names: ModuleNames


class ComponentDraft(_Document, frozen=True):
    """Of a component's file: its document, but for what its imports and its state machine will be called."""

    imports: tuple[ImportDraft, ...]
    machine: NamedMachine | None = None


class ParametersDraft(_Document, frozen=True):
    """Of a file that declares parameters: its document, but for the component that it belongs to."""


class ValuesDraft(_Document, frozen=True):
    """Of the values for such a file: their document, but for the path of what declares them."""


class ConfigDraft(msgspec.Struct, frozen=True):
    """Of a config: its document is made together with those of the other configs of its component."""

    settings: ConfigSettings
    around: Notes


class DeploymentDraft(msgspec.Struct, frozen=True):
    """Of a manager or a launcher: its document is made once the run's components are known."""

    network: NetworkDraft
    around: Notes


class MachineDraft(msgspec.Struct, frozen=True):
    """Of a state machine: the whole text of its SCXML."""

    text: str


FileDraft = ModuleDraft | ComponentDraft | ParametersDraft | ValuesDraft | ConfigDraft | DeploymentDraft | MachineDraft


class Reader(msgspec.Struct, eq=False):
    """What converters share: the file, its rules, where its comments belong, and what there is to say about it."""

    source: SourceText
    rules: Rules
    parsed: Parsed
    placed: PlacedComments
    diagnostics: list[Diagnostic] = []

    @property
    def tree(self) -> Tree[Token]:
        """What was parsed: nobody converts what could not be."""
        assert self.parsed.tree is not None
        return self.parsed.tree

    def span(self, node: Tree[Token] | Token) -> Span:
        if isinstance(node, Token):
            return self.source.span(node.start_pos or 0, node.end_pos or 0)
        return self.source.span(node.meta.start_pos, node.meta.end_pos)

    def notes(self, tree: Tree[Token]) -> Notes:
        return self.placed.of(tree)

    def name(self, tree: Tree[Token]) -> str:
        """The name of a construct."""
        found = token(tree, "NAME")
        return plain(found) if found is not None else ""

    def repaired(self, repair: str, node: Tree[Token] | Token, text: str = "", **facts: str) -> None:
        what = self.rules.repairs[repair].format(text=text, **facts)
        self.diagnostics.append(codes.REPAIRED.at(self.span(node), what=what))

    def refused(self, refusal: str, node: Tree[Token] | Token, text: str = "", **facts: str) -> None:
        reason = self.rules.refusals[refusal]
        self.diagnostics.append(
            codes.REFUSED.at(self.span(node), reason=reason.format(text=text, **facts) if text else reason)
        )

    def lost(self, loss: str, node: Tree[Token] | Token, text: str = "", **facts: str) -> None:
        what = self.rules.losses[loss].format(text=text, **facts)
        self.diagnostics.append(codes.LOST.at(self.span(node), what=what))

    def word(self, what: str, text: str, at: Tree[Token] | Token) -> str:
        """A word in its one spelling; an error for a word that is none of those known."""
        known = self.rules.values[what]
        if text.lower() not in known:
            hint = did_you_mean(text, known, otherwise="write " + " or ".join(dict.fromkeys(known.values())))
            self.diagnostics.append(codes.UNKNOWN_VALUE.at(self.span(at), what=what, value=text, hint=hint))
        return known.get(text.lower(), text)

    def gui(self, words: list[str], at: list[Tree[Token] | Token]) -> Map:
        """Toolkit and base class of a window, and where each stands."""
        toolkit = self.word("toolkit", words[0], at[0])
        base = self.word("base", words[1], at[1]) if words[1:] else self.rules.defaults["base"]
        return Map([DocumentEntry("toolkit", toolkit), DocumentEntry("base", base)])

    def port(self, interface: str, used: Collection[str], declared: Collection[str], ros: Tree[Token] | None) -> Value:
        """An entry of a list of ports: a second one of the same interface has a number behind its name. `ros` is what
        says that it is one of ROS."""
        name, number = interface, 0
        while name in used or (number and name in declared):
            number += 1
            name = f"{interface}{number}"
        if ros is not None:
            self.diagnostics.append(codes.MIDDLEWARE.at(self.span(ros), name=interface))
            return Map(
                [
                    DocumentEntry(
                        name, Map([DocumentEntry("interface", interface), DocumentEntry("x-middleware", "ros")])
                    )
                ]
            )
        return interface if name == interface else Map([DocumentEntry(name, interface)])

    def doc(self, tree: Tree[Token], *names: str) -> str:
        """The doc comments of a construct as Markdown; markup that only names it goes."""
        lines = self.notes(tree).doc
        if not lines:
            return ""
        drop = self.rules.doc.drop
        if any(re.match(drop.replace("{name}", "(?:.*)"), line.strip()) for line in lines):  # seldom, for any name
            own = "|".join(re.escape(name) for name in names if name)
            lines = [line for line in lines if not re.match(drop.replace("{name}", f"(?:{own})"), line.strip())]
        text = re.sub(self.rules.doc.strip, "", "\n".join(lines).replace("\t", " "), flags=re.MULTILINE)
        return trimmed(text)

    def imports(self, nodes: list[Tree[Token]]) -> tuple[List, list[ImportDraft]]:
        """The list under `imports:`, each file once."""
        listed, drafts = List(), list[ImportDraft]()
        for node in nodes:
            literal = next(child for child in node.children if isinstance(child, Token))
            path = re.sub(r'^[^"<]*["<]|[">]$', "", str(literal)).strip()
            if not base_name(path):
                self.diagnostics.append(codes.SYNTAX.at(self.span(literal), problem="an import of nothing", hint=""))
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
    """A node of a network. `at` is where its name stands, in `whole`."""
    node = NetworkNode(name, safe_name(name, [known.name for known in network.nodes]), reader.span(at), notes=notes)
    if not name.strip():
        reader.refused("unnamed", whole)
    if any(name == known.alias for known in network.nodes):
        reader.diagnostics.append(codes.DUPLICATE.at(node.span, name=name))
    elif node.name != name and name.strip():
        reader.repaired("name", at, name, name=node.name)
    network.nodes.append(node)
    return node


class ComponentBuilder:
    """The document of a component, key by key, whatever the format that says it."""

    def __init__(self, reader: Reader) -> None:
        self.reader = reader
        self.entries: dict[str, DocumentEntry] = {}
        self.machine: NamedMachine | None = None

    def put(self, key: str, value: Value, notes: Notes | None = None) -> DocumentEntry:
        self.entries[key] = DocumentEntry(key, value, notes or Notes())
        return self.entries[key]

    def put_machine(self, path: str, at: Tree[Token] | Token, notes: Notes | None = None) -> None:
        entry = self.put("statemachine", path, notes)
        self.machine = NamedMachine(path, self.reader.span(at), entry)
        entry.value = self.machine.document

    def draft(self, at: Tree[Token] | Token, imports: Iterable[ImportDraft], around: Notes) -> ComponentDraft:
        """What was put, in the order of the rules, and then the rest. `at` is where the component is named."""
        if "language" not in self.entries:
            name = self.entries["component"].value
            self.reader.diagnostics.append(codes.NO_LANGUAGE.at(self.reader.span(at), name=name))
        entries = {key: self.entries[key] for key in self.reader.rules.order if key in self.entries} | self.entries
        return ComponentDraft(Map([*entries.values()], block=True), around, tuple(imports), self.machine)


def plain(name: Token) -> str:
    """An identifier without the '\\' that lets Slice use a keyword as one."""
    return str(name).lstrip("\\")


def base_name(path: str) -> str:
    """`X` for `/a/b/X.idsl`, `X.ice` and `X`."""
    return re.sub(r"\.(?:idsl|ice)$", "", re.split(r"[/\\]", path)[-1], flags=re.IGNORECASE)


def trimmed(text: str) -> str:
    """Without blank lines around it, and without blanks around its first and behind each line."""
    lines = [line.rstrip() for line in text.split("\n")]
    while lines and not lines[0]:
        del lines[0]
    return "\n".join([lines[0].lstrip(), *lines[1:]]).rstrip() if lines else ""
