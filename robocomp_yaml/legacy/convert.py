"""One legacy file to a draft: read, recognized, parsed, reviewed, converted. Pure but for reading the file."""

from __future__ import annotations

import importlib
import unicodedata
from contextlib import nullcontext

import msgspec
from lark import Token, Tree

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic, has_errors
from robocomp_yaml.legacy import comments, directives
from robocomp_yaml.legacy.draft import FileDraft, Reader, plain
from robocomp_yaml.legacy.formats import by_name, recognize
from robocomp_yaml.legacy.grammar import Parsed, marked, parse, words
from robocomp_yaml.legacy.reading import Source, read
from robocomp_yaml.legacy.rules import Formats, Rules, formats


class Converted(msgspec.Struct, frozen=True):
    """A legacy file with what became of it. No draft: it is refused."""

    path: str
    rules: Rules | None = None
    source: Source | None = None
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
    with rules.plugin.guarded(f"legacy format '{rules.name}'") if rules.plugin else nullcontext():
        parsed = parse(source, rules)
        said += parsed.diagnostics
        draft = _draft(parsed, source, rules, said)
    return Converted(path, rules, source, parsed, draft, tuple(said))


def _draft(parsed: Parsed, source: Source, rules: Rules, said: list[Diagnostic]) -> FileDraft | None:
    if parsed.tree is None:
        return None
    said += _review(parsed.tree, source, rules)
    placed = comments.place(parsed.tree, parsed.comments, source, rules)
    said += placed.diagnostics
    reader = Reader(source, rules, parsed, placed)
    draft: FileDraft | None = importlib.import_module(rules.converter).convert(reader)
    said += reader.diagnostics
    marks = directives.review(parsed.trivia, source, rules)
    refused = has_errors([*said, *marks])
    said += [mark for mark in marks if not refused or mark.severity == ERROR]  # a refused file loses nothing
    return None if refused else draft


def _review(tree: Tree[Token], source: Source, rules: Rules) -> list[Diagnostic]:
    """What the grammar took although it is not right, and names that cannot be names."""
    said: list[Diagnostic] = []
    for node, start, end in marked(tree, "lenient_"):
        what = rules.repairs[str(node.data)].format(text=words(node))
        said.append(codes.REPAIRED.at(source.span(start, end), what=what))
    for node, start, end in marked(tree, "refused_"):
        said.append(codes.REFUSED.at(source.span(start, end), reason=rules.refusals[str(node.data)]))
    for token in tree.scan_values(lambda value: isinstance(value, Token) and value.type == "NAME"):
        if not rules.names.fullmatch(plain(token)):
            at = source.span(token.start_pos or 0, token.end_pos or 0)
            said.append(codes.BAD_NAME.at(at, name=plain(token), hint=_name_hint(plain(token))))
    return said


def _name_hint(name: str) -> str:
    """How a name could be written, where accents are all that is wrong with it."""
    bare = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode()
    hint = "a name has the letters A to Z without accents, digits and underscores"
    return f"{hint}: for instance '{bare}'" if bare.isidentifier() else hint
