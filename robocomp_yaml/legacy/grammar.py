"""Parse a legacy text by the grammar of its format: the tree and the tokens that it skips, or all syntax errors."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache

import msgspec
from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedInput
from lark.lexer import PatternRE, PatternStr, TerminalDef
from lark.tree import Meta

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.legacy import syntax_error
from robocomp_yaml.legacy.reading import SourceText
from robocomp_yaml.legacy.rules import Rules
from robocomp_yaml.source import properties

MAX_ERRORS = 20
"""At most this many syntax errors are reported for a file: a file with more is of another format."""

MAX_DEPTH = 150
"""At most this deep may constructs be nested. Real files have less than a quarter of it."""

COMMENTS = ("LINE_COMMENT", "BLOCK_COMMENT", "METADATA")
_IGNORED = re.compile(r"^%ignore (?!BLANK)(\w+)", re.MULTILINE)


class Parsed(msgspec.Struct, frozen=True):
    """`trivia` are the tokens that the grammar ignores, such as comments, in order. Without a tree there are errors."""

    tree: Tree[Token] | None
    trivia: tuple[Token, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()

    @property
    def comments(self) -> list[Token]:
        return [token for token in self.trivia if token.type in COMMENTS]


class _FormatParser(msgspec.Struct, frozen=True):
    lark: Lark
    trivia: list[Token]
    literals: dict[str, str]


@cache
def _parser(text: str) -> _FormatParser:
    trivia: list[Token] = []

    def keep(token: Token) -> Token:
        trivia.append(token)
        return token

    literals: dict[str, str] = {}

    def edit(terminal: TerminalDef) -> None:
        """Match keywords only as whole words, also where no name could follow them."""
        if isinstance(terminal.pattern, PatternStr):
            literals[terminal.name] = terminal.pattern.value
            if terminal.pattern.value.isalpha():
                terminal.pattern = PatternRE(rf"{terminal.pattern.value}\b", terminal.pattern.flags)
                terminal.priority = 1

    lark = Lark(
        text,
        parser="lalr",
        lexer="contextual",
        propagate_positions=True,
        maybe_placeholders=False,
        lexer_callbacks=dict.fromkeys(_IGNORED.findall(text), keep),
        edit_terminals=edit,
    )
    return _FormatParser(lark, trivia, literals)


def parse(source: SourceText, rules: Rules) -> Parsed:
    """Return the tree of a text, or its syntax errors. After an error, the statement around it is blanked and the
    text is parsed again, to find the next error."""
    if not rules.grammar:
        return parse_flat(source.text)
    parser = _parser(rules.grammar)
    text: str | None = source.text
    diagnostics: list[Diagnostic] = []
    while text is not None and len(diagnostics) < MAX_ERRORS:
        parser.trivia.clear()
        try:
            tree = parser.lark.parse(text)
        except UnexpectedInput as error:
            fault = syntax_error.SyntaxExplainer(source, rules, parser.literals, text).explain(error)
            if not (fault.at_end and any(diagnostic.fact("missing") == "}" for diagnostic in diagnostics)):
                diagnostics.append(fault.diagnostic)
            text = fault.rest
        else:
            if not diagnostics and _depth(tree) > MAX_DEPTH:
                problem = f"this file nests constructs more than {MAX_DEPTH} levels deep"
                diagnostics.append(codes.SYNTAX.at(Span(source.path), problem=problem, hint=""))
            return Parsed(None if diagnostics else tree, tuple(parser.trivia), tuple(diagnostics))
    return Parsed(None, (), tuple(diagnostics))


class LineTree(Tree[Token]):
    """A line that is not blank: an `entry`, or one that Ice ignores (None). `rest` is the text after its `=`, with the
    comment."""

    def __init__(self, line: properties.PropertyLine, start: int, rest: str) -> None:
        meta = Meta()  # type: ignore[no-untyped-call]
        meta.empty, meta.start_pos, meta.end_pos = False, start, line.stop
        super().__init__("invalid" if line.entry is None else "entry", [], meta)
        self.entry = line.entry
        self.rest = rest


def parse_flat(text: str) -> Parsed:
    """Return a flat config as a tree: each line that `source.properties` reads is a construct, which can have
    comments."""
    lines: list[LineTree] = []
    comments: list[Token] = []
    for line in properties.read(text).lines:
        if line.entry is not None:
            lines.append(LineTree(line, line.start, text[line.entry.at : line.end]))
        elif bare := text[line.start : line.stop].lstrip(" \t\r"):
            lines.append(LineTree(line, line.stop - len(bare), ""))
        if line.stop < line.end:
            comment = text[line.stop : line.end]
            comments.append(Token("LINE_COMMENT", comment, start_pos=line.stop, end_pos=line.end))
    return Parsed(Tree("start", list(lines)), tuple(comments))


def _depth(tree: Tree[Token]) -> int:
    """Return how deep the constructs of a file are nested."""
    count, level = 0, [tree]
    while level:
        count += 1
        level = [child for node in level for child in node.children if isinstance(child, Tree)]
    return count


def marked(tree: Tree[Token], prefix: str, end: int = 0) -> Iterator[tuple[Tree[Token], int, int]]:
    """Yield the outermost subtrees whose rule's name starts with `prefix`, each with its start and end.

    An empty subtree (something is missing) is located at the end of the token before it, or at `end` without one.
    """
    for child in tree.children:
        if not isinstance(child, Tree):
            end = child.end_pos or end
            continue
        if str(child.data).startswith(prefix):
            yield (child, end - 1, end) if child.meta.empty else (child, child.meta.start_pos, child.meta.end_pos)
        else:
            yield from marked(child, prefix, child.meta.start_pos if not child.meta.empty else end)
        end = end if child.meta.empty else child.meta.end_pos


def words(tree: Tree[Token]) -> str:
    """Return the tokens of a subtree, as a message quotes them."""
    return " ".join(str(token) for token in tree.scan_values(lambda value: isinstance(value, Token)))


def token(tree: Tree[Token], kind: str) -> Token | None:
    """Return the first token of a kind directly below a tree; None where it has none."""
    return next((child for child in tree.children if isinstance(child, Token) and child.type == kind), None)


def trees(tree: Tree[Token], *kinds: str) -> list[Tree[Token]]:
    """Return the subtrees of these kinds directly below a tree; without kinds, all of them."""
    below = [child for child in tree.children if isinstance(child, Tree)]
    return [child for child in below if not kinds or child.data in kinds]
