"""Definition, references, hover and symbols: in documents, and definition, references and hover from code, too."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

from lsprotocol import types

from robocomp_yaml.api.completing import schema_keys, values
from robocomp_yaml.api.completing.places import TypedPlace, typed_at
from robocomp_yaml.api.completing.proposals import kind_at
from robocomp_yaml.diag.span import Span
from robocomp_yaml.lsp.from_code import in_slice, name_in_code
from robocomp_yaml.lsp.messages import Messages, real_path
from robocomp_yaml.lsp.server import Server
from robocomp_yaml.lsp.session import KnownNames
from robocomp_yaml.lsp.users import described
from robocomp_yaml.naming import names
from robocomp_yaml.naming.in_generated import places_in_generated
from robocomp_yaml.naming.names import DefinedName, Key
from robocomp_yaml.naming.of_files import named_files
from robocomp_yaml.naming.places_in_code import places_in_code
from robocomp_yaml.source.disk import Disk

_Answer = TypeVar("_Answer")
_SYMBOLS = {
    names.MODULE: types.SymbolKind.Module, names.INTERFACE: types.SymbolKind.Interface,
    names.TOPIC: types.SymbolKind.Interface, names.METHOD: types.SymbolKind.Method,
    names.EVENT: types.SymbolKind.Event, names.TYPE: types.SymbolKind.Struct,
    names.EXCEPTION: types.SymbolKind.Struct, names.CONSTANT: types.SymbolKind.Constant,
    names.MEMBER: types.SymbolKind.Field, names.COMPONENT: types.SymbolKind.Class,
    names.PARAMETER: types.SymbolKind.Property, names.PARAMETER_TYPE: types.SymbolKind.Struct,
    names.DEPLOYMENT: types.SymbolKind.Package, names.ENTRY: types.SymbolKind.Object,
    names.GROUP: types.SymbolKind.Namespace,
}  # fmt: skip
_MANY = 500  # symbols of a workspace


def add(server: Server) -> None:
    def asked(
        params: types.DefinitionParams
        | types.ReferenceParams
        | types.HoverParams
        | types.ImplementationParams
        | types.DeclarationParams,
        answer: Callable[[DefinedName, types.Range, KnownNames, Messages], _Answer],
    ) -> _Answer | None:
        """The answer about the name at a position; None if there is none."""
        path = real_path(params.text_document.uri)
        if path is None:
            return None
        is_document = server.session.is_checked(path)
        if is_document and path not in server.session.open:
            return None
        known = server.session.names_around(path)
        lines = server.lines(server.session.text_of(path))  # code need not be open
        place = lines.place(params.position)
        found = known.names.at(path, *place) if is_document else name_in_code(server.session, path, *place)
        if found is None:
            return None
        return answer(found[1], lines.range(found[0]), known, server.messages(known.texts))

    def located(
        params: types.ReferenceParams | types.ImplementationParams | types.DeclarationParams,
        spans: Callable[[DefinedName, KnownNames], Iterable[Span]],
    ) -> list[types.Location] | None:
        """The places of the name at a position that `spans` finds."""
        return asked(params, lambda one, _, known, messages: [messages.location(span) for span in spans(one, known)])

    @server.answers(types.TEXT_DOCUMENT_DEFINITION)
    def definition(params: types.DefinitionParams) -> types.Location | None:
        return asked(params, lambda one, _, known, messages: messages.location(one.span)) or linked(params)

    def linked(params: types.DefinitionParams) -> types.Location | None:
        """The file that a path in a document means."""
        if (document := server.document(params.text_document)) is None:
            return None
        known = server.session.names_around(document.path)
        line, column = server.lines(document.text).place(params.position)
        for span, file in named_files(known.analysis, known.names, document.path):
            if span.line == line == span.end_line and span.column <= column <= span.end_column:
                return server.messages(known.texts).location(Span(file))
        return None

    @server.answers(types.TEXT_DOCUMENT_REFERENCES)
    def references(params: types.ReferenceParams) -> list[types.Location] | None:
        def spans(one: DefinedName, known: KnownNames) -> Iterator[Span]:
            own = [one.span] if params.context.include_declaration else []
            yield from sorted({*own, *known.names.uses.get(one.key, ())})
            yield from sorted(span for span, _ in _in_code(one, known))
            yield from _in_generated(one, known)

        return located(params, spans)

    @server.answers(types.TEXT_DOCUMENT_DECLARATION)
    def declaration(params: types.DeclarationParams) -> list[types.Location] | None:
        """What was generated from a name, and Slice that was written by hand with it."""
        return located(params, _in_generated)

    def _in_generated(one: DefinedName, known: KnownNames) -> Iterator[Span]:
        yield from places_in_generated(known.program, known.names, one)
        yield from in_slice(server.session, known, one)

    @server.answers(types.TEXT_DOCUMENT_IMPLEMENTATION)
    def implementation(params: types.ImplementationParams) -> list[types.Location] | None:
        """The methods in the user's code that implement a method, or handle an event or a state."""
        return located(params, lambda one, known: sorted(span for span, is_method in _in_code(one, known) if is_method))

    def _in_code(one: DefinedName, known: KnownNames) -> list[tuple[Span, bool]]:
        workspace = server.session.workspace_of(one.span.file)
        look = workspace.living.look(workspace.root)
        return places_in_code(look.analysis, known.names, one, lambda texts: look.with_texts(texts).analysis)

    @server.answers(types.TEXT_DOCUMENT_HOVER)
    def hover(params: types.HoverParams) -> types.Hover | None:
        def answer(one: DefinedName, where: types.Range, known: KnownNames, messages: Messages) -> types.Hover:
            told = _of_schema(params)
            count = len(set(known.names.uses.get(one.key, ())))
            uses = "not used" if not count else "used once" if count == 1 else f"used {count} times"
            parts = [f"```\n{one.says}\n```", one.doc, *described(known.analysis, one), f"{uses} in documents"]
            text = "\n\n".join(part for part in parts if part)
            return _markdown(f"{text}\n\n---\n\n{told[0]}" if told is not None else text, where)

        def of_value() -> types.Hover | None:
            """What the value of a parameter is, unless a server of schemas says it. None knows the keys of `set:`."""
            path = real_path(params.text_document.uri) or ""
            found = _typed(params)
            if found is None or (found[0] == "config" and server.has_schema_server(path)):
                return None
            kind, place, where = found
            text = values.about_value(path, kind, place, server.session.names_around(path).program)
            return _markdown(text, where) if text else None

        def of_schema() -> types.Hover | None:
            told = _of_schema(params)
            return _markdown(*told) if told is not None else None

        return asked(params, answer) or of_value() or of_schema()

    def _typed(params: types.HoverParams) -> tuple[str, TypedPlace, types.Range] | None:
        """The kind of an open document, and the key or value at a position with its range."""
        if (document := server.document(params.text_document)) is None:
            return None
        path, lines = document.path, server.lines(document.text)
        place = typed_at(document.text, *lines.place(params.position))
        if place is None or place.column == place.end_column:
            return None
        where = lines.range(Span(path, place.line, place.column, place.line, place.end_column))
        return kind_at(path, Disk({path: document.raw})), place, where

    def _of_schema(params: types.HoverParams) -> tuple[str, types.Range] | None:
        """What the schema says of the key or value at a position, unless a server of schemas says it."""
        path = real_path(params.text_document.uri) or ""
        found = _typed(params)
        if found is None or server.has_schema_server(path):
            return None
        kind, place, where = found
        line = server.lines(server.session.text_of(path)).line(place.line)
        word = line[place.column - 1 : place.end_column - 1]
        text = schema_keys.about(kind, (*place.keys, word) if place.is_key else place.keys)
        return (text, where) if text else None

    @server.answers(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    def symbols(params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
        path = real_path(params.text_document.uri)
        if path is None or path not in server.session.open:
            return []
        known = server.session.names_around(path)
        return _tree(known.names.in_document(path), server.messages(known.texts))

    @server.answers(types.WORKSPACE_SYMBOL)
    def all_symbols(params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
        found = []
        for known in server.session.names_everywhere():
            messages = server.messages(known.texts)
            for one in known.names.defined.values():
                if _matches(params.query, one.name) and one.kind in _SYMBOLS:
                    found.append(types.WorkspaceSymbol(messages.location(one.span), one.name, _SYMBOLS[one.kind]))
        return found[:_MANY]


def _markdown(text: str, where: types.Range) -> types.Hover:
    return types.Hover(types.MarkupContent(types.MarkupKind.Markdown, text), where)


def _matches(query: str, name: str) -> bool:
    """Whether the letters of the query are in the name, in this order."""
    rest = iter(name.lower())
    return all(letter in rest for letter in query.lower())


def _tree(defined: Iterable[DefinedName], messages: Messages) -> list[types.DocumentSymbol]:
    made: dict[Key, types.DocumentSymbol] = {}
    top: list[types.DocumentSymbol] = []
    for one in defined:
        if one.kind == names.ARGUMENT:
            continue  # it is in what its method says
        where = messages.location(one.span).range
        kind = _SYMBOLS.get(one.kind, types.SymbolKind.Key)
        made[one.key] = symbol = types.DocumentSymbol(one.name, kind, where, where, one.says, children=[])
        outer = made.get(one.inside)
        (top if outer is None else list_of(outer)).append(symbol)
    return top


def list_of(symbol: types.DocumentSymbol) -> list[types.DocumentSymbol]:
    """The children of a symbol, to which others are added."""
    children = symbol.children
    assert isinstance(children, list)
    return children
