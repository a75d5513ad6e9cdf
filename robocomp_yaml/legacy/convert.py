"""One legacy file to a draft: read, recognized, parsed, reviewed, converted. Pure but for reading the file."""

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
    """A legacy file with what became of it. No draft: it is refused."""

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
    """The draft of a file that is in one of the known formats, by default the built-in ones."""
    known = formats() if known is None else known
    source, said = read(path)
    if source is None:
        return Converted(path, by_name(path, known), diagnostics=tuple(said))
    rules, told = recognize(source, known)
    said += told
    if rules is None:
        return Converted(path, by_name(path, known), source, diagnostics=tuple(said))
    with rules.plugin.answering(f"legacy format '{rules.name}'") if rules.plugin else nullcontext():
        parsed = parse(source, rules)
        said += parsed.diagnostics
        draft = _draft(parsed, source, rules, said)
    return Converted(path, rules, source, parsed, draft, tuple(said))


def _draft(parsed: Parsed, source: SourceText, rules: Rules, said: list[Diagnostic]) -> FileDraft | None:
    if parsed.tree is None:
        return None
    placed = comments.place(parsed.tree, parsed.comments, source, rules)
    reader = Reader(source, rules, parsed, placed)
    _review(reader)
    reader.diagnostics += placed.diagnostics
    draft: FileDraft | None = importlib.import_module(rules.converter).convert(reader)
    said += reader.diagnostics
    reader.diagnostics = []
    directives.review(parsed.trivia, reader)
    refused = has_errors([*said, *reader.diagnostics])
    # A refused file loses nothing.
    said += [mark for mark in reader.diagnostics if not refused or mark.severity == ERROR]
    return None if refused else draft


def _review(reader: Reader) -> None:
    """What the grammar took although it is not right, and names that cannot be names."""
    for node, start, end in marked(reader.tree, "lenient_"):
        what = reader.rules.repairs[str(node.data)].format(text=words(node))
        reader.diagnostics.append(codes.REPAIRED.at(reader.source.span(start, end), what=what))
    for node, start, end in marked(reader.tree, "refused_"):
        reason = reader.rules.refusals[str(node.data)]
        reader.diagnostics.append(codes.REFUSED.at(reader.source.span(start, end), reason=reason))
    for token in reader.tree.scan_values(lambda value: isinstance(value, Token) and value.type == "NAME"):
        name = plain(token)
        if not reader.rules.names.fullmatch(name):
            reader.diagnostics.append(codes.BAD_NAME.at(reader.span(token), name=name, hint=_name_hint(name)))


def _name_hint(name: str) -> str:
    """How a name could be written, where accents are all that is wrong with it."""
    bare = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode()
    hint = "a name has the letters A to Z without accents, digits and underscores"
    return f"{hint}: for instance '{bare}'" if bare.isidentifier() else hint
