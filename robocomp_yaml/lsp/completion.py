"""Completion over the protocol: what `api.completing` proposes, as items of the protocol."""

from __future__ import annotations

from lsprotocol import types

from robocomp_yaml.api.completing import schema_keys
from robocomp_yaml.api.completing.places import typed_at
from robocomp_yaml.api.completing.proposal import CODE, PATH, VALUE, Proposal
from robocomp_yaml.api.completing.proposals import codes_at, importing, of_schema_server, proposals
from robocomp_yaml.diag.span import Span
from robocomp_yaml.lsp.server import YES, Server
from robocomp_yaml.naming import names

_KINDS = {
    names.MODULE: types.CompletionItemKind.Module, names.INTERFACE: types.CompletionItemKind.Interface,
    names.TOPIC: types.CompletionItemKind.Event, names.TYPE: types.CompletionItemKind.Struct,
    names.EXCEPTION: types.CompletionItemKind.Struct, names.COMPONENT: types.CompletionItemKind.Class,
    names.PARAMETER: types.CompletionItemKind.Property, names.STATE: types.CompletionItemKind.EnumMember,
    VALUE: types.CompletionItemKind.Value, CODE: types.CompletionItemKind.Constant, PATH: types.CompletionItemKind.File,
    schema_keys.KEY: types.CompletionItemKind.Property, schema_keys.SNIPPET: types.CompletionItemKind.Snippet,
}  # fmt: skip


def add(server: Server) -> None:
    @server.answers(types.TEXT_DOCUMENT_COMPLETION, types.CompletionOptions(trigger_characters=[".", "[", " "]))
    def complete(params: types.CompletionParams) -> list[types.CompletionItem]:
        if (document := server.document(params.text_document)) is None:
            return []
        path = document.path
        lines = server.lines(document.text)
        line, column = lines.place(params.position)
        reported = server.session.workspace_of(path).found.get(path, ())
        coded = codes_at(lines.line(line), column, reported, line)
        if coded is not None:
            where = lines.range(Span(path, line, coded[0], line, column))
            return [_item(one, where, [], f"{n:04}") for n, one in enumerate(coded[1])]
        place = typed_at(document.text, line, column)
        if place is None:
            return []
        known = server.session.names_around(path, may_be_old=True)
        with_schema = not server.has_schema_server(path)
        where = lines.range(Span(path, place.line, place.column, place.line, place.end_column))
        program = known.program
        importable = server.session.importable(path)
        made = proposals(path, place, known.names, importable, program, with_schema=with_schema)
        # A document that is made for a server of schemas may be open in an editor without one.
        told = of_schema_server(path, place) if server.schema_server == YES else frozenset()
        return [
            _item(one, where, [
                types.TextEdit(server.lines(place.text).range(edit.span), edit.text)
                for edit in importing(path, place, one.imports)
            ])
            for one in made if one.text not in told
        ]  # fmt: skip


def _item(one: Proposal, where: types.Range, more: list[types.TextEdit], order: str = "") -> types.CompletionItem:
    is_snippet = one.kind == schema_keys.SNIPPET
    return types.CompletionItem(
        one.text.removesuffix(": "),
        sort_text=order or None,
        insert_text_format=types.InsertTextFormat.Snippet if is_snippet else None,
        kind=_KINDS.get(one.kind, types.CompletionItemKind.Value),
        detail=one.says or None,
        documentation=one.doc or None,
        text_edit=types.TextEdit(where, one.snippet or one.text),
        additional_text_edits=more or None,
    )
