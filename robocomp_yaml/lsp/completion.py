"""Completion of names, which the schemas do not hold: imports, interfaces, topics, types, parameters, components, hosts
and entries of deployments. Keys and basic types are completed by the server of the schemas."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator

import msgspec
from lsprotocol import types

from robocomp_yaml.diag.fix import IMPORT, Edit
from robocomp_yaml.diag.span import Span
from robocomp_yaml.lsp.messages import real_path
from robocomp_yaml.lsp.places import TypedPlace, typed_at
from robocomp_yaml.lsp.server import Server
from robocomp_yaml.naming import names
from robocomp_yaml.naming.names import DefinedName, Names
from robocomp_yaml.source.discover import kind_of
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.spelled import DocumentText
from robocomp_yaml.source.tree import Mapping, Sequence

_SUFFIX = ".idsl.yaml"
_PORTS = {
    "implements": names.INTERFACE, "requires": names.INTERFACE, "publishes": names.TOPIC, "subscribes": names.TOPIC,
}  # fmt: skip
_OF_TYPES = ("struct", "sequence", "map", "in", "out", "returns", "type")
_KINDS = {
    names.MODULE: types.CompletionItemKind.Module, names.INTERFACE: types.CompletionItemKind.Interface,
    names.TOPIC: types.CompletionItemKind.Event, names.TYPE: types.CompletionItemKind.Struct,
    names.EXCEPTION: types.CompletionItemKind.Struct, names.COMPONENT: types.CompletionItemKind.Class,
    names.PARAMETER: types.CompletionItemKind.Property,
}  # fmt: skip


class Proposal(msgspec.Struct, frozen=True):
    """A text that can stand at the cursor. `imports` is what the document must import for it."""

    text: str
    kind: str = ""
    says: str = ""
    doc: str = ""
    imports: str = ""


def proposals(path: str, place: TypedPlace, known: Names, importable: Iterable[str]) -> list[Proposal]:
    """What can stand at a place of a document, each once."""
    found: Iterator[Proposal] = iter(())
    match kind_of(path, Disk()) or _kind_by_name(path):
        case "idsl":
            found = _in_interfaces(path, place, known, importable)
        case "cdsl":
            found = _in_component(path, place, known, importable)
        case "pdsl":
            found = _in_parameters(place)
        case "ddsl":
            found = _in_deployment(path, place, known)
    return list({one.text: one for one in found}.values())


def _kind_by_name(path: str) -> str:
    return os.path.basename(path).removesuffix(".yaml").rpartition(".")[2]


def _imports(path: str, place: TypedPlace, importable: Iterable[str]) -> Iterator[Proposal]:
    own = os.path.basename(path).removesuffix(_SUFFIX)
    present = set(_items(place.root, "imports"))
    return (Proposal(name, names.MODULE) for name in importable if name != own and name not in present)


def _in_interfaces(path: str, place: TypedPlace, known: Names, importable: Iterable[str]) -> Iterator[Proposal]:
    keys = place.keys
    if keys[:1] == ("imports",) and not place.is_key:
        yield from _imports(path, place, importable)
    elif not place.is_key and len(keys) > 2 and keys[0] in ("interfaces", "topics", "types", "exceptions", "constants"):
        is_exception = "throws" in keys[3:]
        if is_exception or any(key in _OF_TYPES for key in keys[2:]):
            yield from _types(place, known, "exceptions" if is_exception else "types")


def _types(place: TypedPlace, known: Names, section: str) -> Iterator[Proposal]:
    kind = names.EXCEPTION if section == "exceptions" else names.TYPE
    yield from (Proposal(name, kind, f"{kind} of this module") for name in _keys(place.root, section))
    for stem, one in _of_imported(place, known, kind):
        yield Proposal(f"{stem}.{one.name}", kind, one.says, one.doc)


def _in_component(path: str, place: TypedPlace, known: Names, importable: Iterable[str]) -> Iterator[Proposal]:
    keys = place.keys
    if keys[:1] == ("imports",) and not place.is_key:
        yield from _imports(path, place, importable)
    elif keys and keys[0] in _PORTS and not place.is_key and (len(keys) < 4 or keys[3] == "interface"):
        kind = _PORTS[keys[0]]
        for _, one in _of_imported(place, known, kind):
            yield Proposal(one.name, kind, one.says, one.doc)
        stems = {stem for stem, _ in _of_imported(place, known, names.MODULE)}
        can_be_imported = set(importable)
        for one in known.of_kinds(kind):
            stem = _stem(one)
            if stem not in stems and stem in can_be_imported:
                yield Proposal(one.name, kind, f"{one.says}, imports {stem}", one.doc, stem)


def _in_parameters(place: TypedPlace) -> Iterator[Proposal]:
    if not place.is_key and place.keys[-1:] in (("type",), ("list",), ("map",)):
        yield from (Proposal(name, names.TYPE, "type of this document") for name in _keys(place.root, "types"))


def _in_deployment(path: str, place: TypedPlace, known: Names) -> Iterator[Proposal]:
    keys, root = place.keys, place.root
    entries = [name for name in _keys(root, "components") if keys[:2] != ("components", name)]
    others = [*_keys(root, "groups"), *_keys(root, "services")]
    match keys:
        case ("components" | "groups" | "services", _, *_, "host") if not place.is_key:
            yield from (Proposal(name, names.HOST) for name in _keys(root, "hosts"))
        case ("components", _, "component") | ("groups", _, "as") if not place.is_key:
            for one in known.of_kinds(names.COMPONENT):
                folder = os.path.relpath(os.path.dirname(one.span.file), os.path.dirname(path))
                yield Proposal(folder, names.COMPONENT, one.says, one.doc)
        case ("components", _, "connect" | "process", *_) if not place.is_key:
            yield from (Proposal(name, names.ENTRY) for name in (*entries, *_keys(root, "groups")))
        case ("components", _, "after", *_) if not place.is_key:
            yield from (Proposal(name, names.ENTRY) for name in (*entries, *others))
        case ("groups", _, "components", *_) if not place.is_key:
            yield from (Proposal(name, names.ENTRY) for name in entries)
        case ("components", entry, "set", *outer) if place.is_key:
            target = root.get("components")
            of_entry = target.get(entry) if target is not None else None
            component = of_entry.get("component") if of_entry is not None else None
            if component is not None:
                yield from _parameters(path, str(component.data), tuple(outer), known)


def _parameters(path: str, component: str, outer: tuple[str, ...], known: Names) -> Iterator[Proposal]:
    """The parameters of a component, which is a folder or a document."""
    named = os.path.normpath(os.path.join(os.path.dirname(path), component))
    folder = os.path.dirname(named) if named.endswith(".yaml") else named
    for one in known.of_kinds(names.PARAMETER):
        if os.path.dirname(one.key[1]) == folder and one.key[2:-1] == outer:
            yield Proposal(one.name, names.PARAMETER, one.says, one.doc)


def _of_imported(place: TypedPlace, known: Names, kind: str) -> Iterator[tuple[str, DefinedName]]:
    """The names of a kind in the modules that the document imports, each with the stem of its module."""
    stems = {name.rpartition("/")[2].removesuffix(_SUFFIX) for name in _items(place.root, "imports")}
    return ((_stem(one), one) for one in known.of_kinds(kind) if _stem(one) in stems)


def _stem(one: DefinedName) -> str:
    return os.path.basename(one.key[1]).removesuffix(_SUFFIX)


def _keys(root: Mapping, section: str) -> list[str]:
    found = root.get(section)
    return [key.lexeme for key, _ in found.items()] if isinstance(found, Mapping) else []


def _items(root: Mapping, section: str) -> list[str]:
    found = root.get(section)
    return [str(item.data) for item in found.items] if isinstance(found, Sequence) else []


def add(server: Server) -> None:
    @server.feature(types.TEXT_DOCUMENT_COMPLETION, types.CompletionOptions(trigger_characters=[".", "[", " "]))
    async def complete(params: types.CompletionParams) -> list[types.CompletionItem]:
        path = real_path(params.text_document.uri) or ""

        def job() -> list[types.CompletionItem]:
            document = server.session.open.get(path)
            if document is None or not server.session.is_document(path):
                return []
            lines = server.lines(document.text)
            place = typed_at(document.text, *lines.place(params.position))
            if place is None:
                return []
            known = server.session.names_around(path, may_be_old=True)
            where = lines.range(Span(path, place.line, place.column, place.line, place.end_column))
            made = proposals(path, place, known.names, server.session.importable(path))
            return [_item(one, where, _importing(server, path, place, one.imports)) for one in made]

        return await server.run(job)


def _item(one: Proposal, where: types.Range, more: list[types.TextEdit]) -> types.CompletionItem:
    return types.CompletionItem(
        one.text,
        kind=_KINDS.get(one.kind, types.CompletionItemKind.Value),
        detail=one.says or None,
        documentation=one.doc or None,
        text_edit=types.TextEdit(where, one.text),
        additional_text_edits=more or None,
    )


def _importing(server: Server, path: str, place: TypedPlace, name: str) -> list[types.TextEdit]:
    """The edits that import a module, if they are in another line than the cursor."""
    if not name:
        return []
    lines = server.lines(place.text)
    edits = DocumentText(path, place.text).spelled(Edit(Span(path), name, IMPORT))
    return [types.TextEdit(lines.range(one.span), one.text) for one in edits if one.span.line != place.line]
