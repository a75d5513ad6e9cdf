"""Convert one legacy file to a draft: read it, detect its format, parse, review and convert it. Nothing is written."""

from __future__ import annotations

import importlib
import unicodedata
from contextlib import nullcontext

import msgspec
from lark import Token

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic, has_errors
from robocomp_yaml.legacy import comments, directives
from robocomp_yaml.legacy.draft import FileDraft, Reader, plain
from robocomp_yaml.legacy.formats import by_name, recognize
from robocomp_yaml.legacy.grammar import Parsed, marked, parse, words
from robocomp_yaml.legacy.reading import SourceText, read
from robocomp_yaml.legacy.rules import Formats, Rules, formats


class Converted(msgspec.Struct, frozen=True):
    """A legacy file and what it was converted to. Without a draft, the file is rejected."""

    path: str
    rules: Rules | None = None
    source: SourceText | None = None
    parsed: Parsed | None = None
    draft: FileDraft | None = None
    diagnostics: tuple[Diagnostic, ...] = ()

    @property
    def refused(self) -> bool:
        return self.draft is None


def convert(path: str, known: Formats | None = None) -> Converted:
    """Return the draft of a file in one of the known formats, by default the built-in ones."""
    known = formats() if known is None else known
    source, diagnostics = read(path)
    if source is None:
        return Converted(path, by_name(path, known), diagnostics=tuple(diagnostics))
    rules, reasons = recognize(source, known)
    diagnostics += reasons
    if rules is None:
        return Converted(path, by_name(path, known), source, diagnostics=tuple(diagnostics))
    with rules.plugin.guarded(f"legacy format '{rules.name}'") if rules.plugin else nullcontext():
        parsed = parse(source, rules)
        diagnostics += parsed.diagnostics
        draft = _draft(parsed, source, rules, diagnostics)
    return Converted(path, rules, source, parsed, draft, tuple(diagnostics))


def _draft(parsed: Parsed, source: SourceText, rules: Rules, diagnostics: list[Diagnostic]) -> FileDraft | None:
    if parsed.tree is None:
        return None
    placed = comments.place(parsed.tree, parsed.comments, source, rules)
    reader = Reader(source, rules, parsed, placed)
    _review(reader)
    reader.diagnostics += placed.diagnostics
    draft: FileDraft | None = importlib.import_module(rules.converter).convert(reader)
    diagnostics += reader.diagnostics
    reader.diagnostics = []
    directives.review(parsed.trivia, reader)
    refused = has_errors([*diagnostics, *reader.diagnostics])
    # A rejected file loses nothing.
    diagnostics += [loss for loss in reader.diagnostics if not refused or loss.severity == ERROR]
    return None if refused else draft


def _review(reader: Reader) -> None:
    """Report the faults that the grammar accepts, and names that are not legal."""
    for node, start, end in marked(reader.tree, "lenient_"):
        what = reader.rules.repairs[str(node.data)].format(text=words(node))
        reader.diagnostics.append(codes.REPAIRED.at(reader.source.span(start, end), what=what))
    for node, start, end in marked(reader.tree, "refused_"):
        reason = reader.rules.refusals[str(node.data)]
        reader.diagnostics.append(codes.REFUSED.at(reader.source.span(start, end), reason=reason))
    for token in reader.tree.scan_values(lambda value: isinstance(value, Token) and value.type == "NAME"):
        name = plain(token)
        if not reader.rules.names.fullmatch(name):
            reader.report(codes.BAD_NAME, token, name=name, hint=_name_hint(name))


def _name_hint(name: str) -> str:
    """Suggest a legal spelling, where accents are the only problem."""
    bare = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode()
    hint = "a name consists of the letters A to Z without accents, digits and underscores"
    return f"{hint}: for example '{bare}'" if bare.isidentifier() else hint
