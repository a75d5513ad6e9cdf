"""One legacy file to a draft: read, recognized, parsed, reviewed, converted. Pure but for reading the file."""

from __future__ import annotations

import unicodedata

import msgspec
from lark import Token, Tree

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic, has_errors
from robocomp_yaml.diag.span import Span
from robocomp_yaml.legacy import comments, directives
from robocomp_yaml.legacy.draft import Draft, Reader, plain
from robocomp_yaml.legacy.formats import by_name, recognize
from robocomp_yaml.legacy.grammar import MAX_DEPTH, Parsed, depth, marked, parse, words
from robocomp_yaml.legacy.reading import Source, read
from robocomp_yaml.legacy.rules import Rules
from robocomp_yaml.registry import Modules

CONVERTERS = Modules("robocomp_yaml.legacy.converters", "converter")


class Converted(msgspec.Struct):
    """A legacy file with what became of it. No draft: it is refused."""

    path: str
    rules: Rules | None = None
    source: Source | None = None
    parsed: Parsed | None = None
    draft: Draft | None = None
    diagnostics: list[Diagnostic] = []

    @property
    def refused(self) -> bool:
        return self.draft is None


def convert(path: str) -> Converted:
    source, diagnostics = read(path)
    if source is None:
        return Converted(path, by_name(path), diagnostics=diagnostics)
    rules, told = recognize(source)
    result = Converted(path, rules or by_name(path), source, diagnostics=diagnostics + told)
    if rules is not None:
        _convert(result, source, rules)
    return result


def _convert(result: Converted, source: Source, rules: Rules) -> None:
    said = result.diagnostics
    result.parsed = parsed = parse(source, rules)
    said += parsed.diagnostics
    if parsed.tree is None:
        return
    if depth(parsed.tree) > MAX_DEPTH:
        parsed.tree = None
        said.append(codes.SYNTAX.at(Span(result.path), problem="this file nests things too deeply", hint=""))
        return
    said += _review(parsed.tree, source, rules)
    placed = comments.place(parsed.tree, parsed.comments, source, rules)
    said += placed.diagnostics
    reader = Reader(source, rules, parsed, placed)
    converter = CONVERTERS.load(rules.converter)
    draft = converter.convert(reader)
    said += reader.diagnostics
    marks = directives.review(parsed.trivia, source, rules)
    refused = has_errors([*said, *marks])
    said += [mark for mark in marks if not refused or mark.severity == ERROR]  # a refused file loses nothing
    result.draft = None if refused else draft


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
