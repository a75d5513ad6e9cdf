"""YAML's syntax: text to composed nodes, with libyaml or, if libyaml rejects the text, with ruamel.yaml's own parser.

libyaml parses the syntax of YAML 1.1, in which `{key: a:b}` is an error; YAML 1.2 allows it. Therefore the result of
the slower parser is final. Both parsers are recursive, libyaml in C without a limit: the depth is checked before.

Both parsers also end lines and comments at three characters that YAML 1.2 and editors treat as part of the line. These
characters are replaced by others while a text is parsed.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from itertools import chain

from ruamel.yaml.cyaml import CParser  # type: ignore[attr-defined]  # from C, without types
from ruamel.yaml.error import MarkedYAMLError
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode
from ruamel.yaml.tag import Tag

from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import Diagnosed
from robocomp_yaml.diag.fix import Edit, Fix
from robocomp_yaml.diag.span import Span
from robocomp_yaml.digraph import reachable
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source import missing_blank

MAX_DEPTH = 100

UNTAGGED = Tag(suffix="")
"""The tag (`ctag`) of composed nodes for which the text has none."""

# A pair of brackets that contains neither brackets nor what can hide one (quotes, comments).
_INNERMOST = pattern(r"""\{[^][{}"'#]*\}|\[[^][{}"'#]*\]""")
_BRACKET = pattern(r"[\[{\]}]")
_LINE_ENDS_OF_1_1 = "\x85\u2028\u2029"
_HAS_THEM = re.compile(f"[{_LINE_ENDS_OF_1_1}]")
_PRIVATE = range(0xE000, 0xF900)  # the private use area of Unicode
# The part of a line in a block that precedes a value.
_BEFORE_A_VALUE = pattern(r"[ ]*(?:- +)*(?:[^\s#\"'\[\]{},:&*!|>@`%][^\"'\[\]{}#]*: +|- +)")
_DOC = pattern(r"([ ]*(?:- +)*(?:doc|description|message): +)(?=[^\s\"'\[{&*!|>])")
_DEEP_BLOCK = pattern(rf"^[ ?\-]{{{MAX_DEPTH}}}", re.MULTILINE)

_MISINDENTED = "the indentation of this line does not match the lines before it"
# Parts of the parsers' messages, each with the message and the hint for the user.
_MESSAGES = (
    ("cannot start any token", "a value cannot start with {found}", "put the text in quotes"),
    (
        "mapping values are not allowed",
        "a ':' starts a mapping here, where none is allowed",
        "put text that contains ': ' in quotes, and check the indentation of the lines above",
    ),
    ("could not find expected ':'", "this line has no ':' after its key", "write 'key: value'"),
    ("expected <block end>", _MISINDENTED, "check the indentation"),
    ("did not find expected key", _MISINDENTED, "check the indentation"),
    (
        "did not find expected '-' indicator",
        "this line is not part of an element of the list",
        "start it with '- ', or indent it",
    ),
    ("did not find expected ',' or '}'", "a '}}' or a ',' is missing before this", ""),
    ("expected ',' or '}'", "a '}}' or a ',' is missing before this", ""),
    ("did not find expected ',' or ']'", "a ']' or a ',' is missing before this", ""),
    ("expected ',' or ']'", "a ']' or a ',' is missing before this", ""),
    ("did not find expected node content", "a value is missing here", ""),
    ("expected the node content", "a value is missing here", ""),
    ("unexpected end of stream", "this quoted text is not closed", "close the quotes"),
    ("document separator", "a quoted text is not closed before '---'", "close the quotes"),
    ("undefined alias", "this alias refers to an unknown anchor (&name)", "quote a text that starts with '*'"),
    ("unknown escape", "unknown escape sequence in double quotes", "double the backslash, or use single quotes"),
    ("duplicate anchor", "this anchor is defined twice", "rename one of them"),
    ("undefined tag handle", "this tag is unknown", "quote a text that starts with '!'"),
)

_AFTER_A_MISSING_BLANK = (
    "mapping values are not allowed", "could not find expected ':'", "expected <block end>",
    "did not find expected key",
)  # fmt: skip

_LONG = 20_000  # characters


class SyntaxFault(Diagnosed):
    """The text is not YAML."""


class Rejected(Exception):
    """libyaml rejects the text, which may be YAML 1.2 nevertheless."""


class _Composer(CParser):  # type: ignore[misc]
    """libyaml's composer; the tag of a node without a tag is UNTAGGED."""

    def resolve(self, kind: type, value: str, implicit: object) -> Tag:
        return UNTAGGED

    def descend_resolver(self, current: object, index: object) -> None:
        pass

    def ascend_resolver(self) -> None:
        pass


def compose(path: str, text: str, *, by_libyaml: bool = False) -> Node | None:
    """The root node, or None for a text without content. Raises SyntaxFault, and `by_libyaml` Rejected: the parser that
    decides then takes a hundred times as long."""
    if not text.isascii() and _HAS_THEM.search(text):
        return _composed_with_stand_ins(path, text, by_libyaml)
    if _may_be_deep(text) and _depth(text) > MAX_DEPTH:
        raise SyntaxFault(codes.TOO_DEEP.at(_deep_location(path, text), limit=MAX_DEPTH))
    root: Node | None
    try:
        root = _Composer(text).get_single_node()
        return root
    except MarkedYAMLError as error:
        fault = error
    if by_libyaml:
        raise Rejected
    if len(text) > _LONG and _is_refused_nearby(text, fault):
        raise SyntaxFault(_diagnostic(path, text, fault))
    try:
        return _compose_as_1_2(text)
    except MarkedYAMLError as error:
        # libyaml's location is more precise: for an unclosed bracket it is not the end of the file.
        raise SyntaxFault(_diagnostic(path, text, fault if fault.problem_mark else error)) from None
    except (RecursionError, ValueError, AttributeError, NotImplementedError):
        raise SyntaxFault(_diagnostic(path, text, fault)) from None


def tokens(text: str) -> Iterator[object]:
    """The tokens of a text, by libyaml. Raises MarkedYAMLError, also for a text that only libyaml's parser refuses: its
    scanner reads `[a?b]` as something else."""
    _Composer(text).get_single_node()
    parser = CParser(text)
    while parser.check_token():
        yield parser.get_token()


def tokens_as_1_2(text: str) -> Iterator[object]:
    """The tokens of a text that libyaml may refuse, by ruamel.yaml's own scanner; Raises MarkedYAMLError."""
    from ruamel.yaml import YAML

    yield from YAML(typ="safe", pure=True).scan(text)


def stand_ins(text: str) -> tuple[str, dict[int, str]]:
    """A text with other characters for those that end lines in YAML 1.1 alone, and the table that brings these back."""
    if text.isascii() or not _HAS_THEM.search(text):
        return text, {}
    used = set(text)
    free = [chr(code) for code in _PRIVATE if chr(code) not in used][: len(_LINE_ENDS_OF_1_1)]
    forth = str.maketrans(_LINE_ENDS_OF_1_1, "".join(free))
    return text.translate(forth), {ord(key): value for key, value in zip(free, _LINE_ENDS_OF_1_1, strict=True)}


def _composed_with_stand_ins(path: str, text: str, by_libyaml: bool) -> Node | None:
    safe, back = stand_ins(text)
    root = compose(path, safe, by_libyaml=by_libyaml)
    for node in _nodes(root):
        if isinstance(node, ScalarNode):
            node.value = node.value.translate(back)
    return root


def _nodes(root: Node | None) -> Iterable[Node]:
    """All nodes of a tree, each once."""

    def inside(node: Node) -> Iterable[Node]:
        return chain.from_iterable(node.value) if isinstance(node, MappingNode) else node.value

    return reachable([root] if root else [], lambda node: () if isinstance(node, ScalarNode) else inside(node))


def _compose_as_1_2(text: str) -> Node | None:
    from ruamel.yaml import YAML

    parser = YAML(typ="safe", pure=True)
    parser.composer.warn_double_anchors = False  # YAML 1.2 allows them, and warnings are for programmers
    root: Node | None = parser.compose(text)
    for node in _nodes(root):
        if not _has_explicit_tag(text, node.start_mark.index):
            node.ctag = UNTAGGED
    return root


def _is_refused_nearby(text: str, fault: MarkedYAMLError) -> bool:
    """Whether the lines where libyaml stopped, below the lines that contain them, are no YAML 1.2: then the whole text
    is none, and the parser that decides need not read it. Only where libyaml stops there for the same reason."""
    if fault.problem_mark is None:
        return False
    first, last = (fault.context_mark or fault.problem_mark).line, fault.problem_mark.line
    lines = text.split("\n")
    above: list[str] = []
    depth = _indentation(lines[first]) if first < len(lines) else 0
    for line in reversed(lines[:first]):
        if not depth:
            break
        if line.strip() and not line.lstrip().startswith("#") and _indentation(line) < depth:
            above.append(line)
            depth = _indentation(line)
    nearby = "\n".join([*reversed(above), *lines[first : last + 1], ""])
    try:
        _Composer(nearby).get_single_node()
        return False
    except MarkedYAMLError as error:
        mark = error.problem_mark
        here = mark and (mark.line + first - len(above), mark.column)
        if error.problem != fault.problem or here != (last, fault.problem_mark.column):
            return False
    try:
        _compose_as_1_2(nearby)
    except MarkedYAMLError:
        return True
    except (RecursionError, ValueError, AttributeError, NotImplementedError):
        return False
    return False


def _indentation(line: str) -> int:
    """How far inside a line is. An item of a list may be as far right as the key of the list."""
    blanks = len(line) - len(line.lstrip(" "))
    return 2 * blanks + line.startswith("- ", blanks)


def _has_explicit_tag(text: str, index: int) -> bool:
    return re.compile(r"(?:&\S+\s+)?!").match(text, index) is not None


def _may_be_deep(text: str) -> bool:
    return _brackets(text) > MAX_DEPTH or _DEEP_BLOCK.search(text) is not None


def _brackets(text: str) -> int:
    """An upper bound of the depth of brackets: those that remain after the innermost pairs are removed a few times."""
    for removed in range(4):
        opened = text.count("[") + text.count("{") + removed
        if opened <= MAX_DEPTH:
            break
        text = _INNERMOST.sub("", text)
    return opened


def _depth(text: str) -> int:
    """The depth of nesting, from libyaml's events, which need no recursion."""
    from ruamel.yaml.events import MappingEndEvent, MappingStartEvent, SequenceEndEvent, SequenceStartEvent

    deepest = depth = 0
    parser = _Composer(text)
    try:
        while parser.check_event():
            event = parser.get_event()
            if isinstance(event, (MappingStartEvent, SequenceStartEvent)):
                depth += 1
                deepest = max(deepest, depth)
                if deepest > MAX_DEPTH:
                    break
            elif isinstance(event, (MappingEndEvent, SequenceEndEvent)):
                depth -= 1
    except MarkedYAMLError:
        pass  # composing reports the error; the depth so far is used
    return deepest


def _deep_location(path: str, text: str) -> Span:
    """The first bracket beyond the limit, or the first line that is indented as far."""
    depth = 0
    for bracket in _BRACKET.finditer(text):
        depth += 1 if bracket[0] in "[{" else -1
        if depth > MAX_DEPTH:
            break
    else:
        bracket = _DEEP_BLOCK.search(text) or bracket
    line = text.count("\n", 0, bracket.start()) + 1
    column = bracket.start() - text.rfind("\n", 0, bracket.start())
    return Span(path, line, column, line, column + 1)


def _diagnostic(path: str, text: str, error: MarkedYAMLError) -> Diagnostic:
    problem = " ".join(str(part) for part in (error.context, error.problem) if part)
    # The start of a key or a quoted text is more useful than the position at which the parser stopped.
    begins = "expected ':'" in problem or ("quoted scalar" in problem and "escape" not in problem)
    mark = (begins and error.context_mark) or error.problem_mark or error.context_mark
    line, column = (mark.line + 1, mark.column + 1) if mark else (1, 1)
    span = Span(path, line, column, line, column + 1)
    if "but found another document" in problem:
        return codes.SEVERAL_DOCUMENTS.at(span, hint="move it to a file of its own")
    lines = re.split("\r\n|\r|\n", text)
    if not lines[-1]:
        del lines[-1]
    if line > len(lines):  # the end of the file: shown after its last character
        line = max(1, len(lines))
        column = len(lines[-1]) + 1 if lines else 1
        span = Span(path, line, column, line, column + 1)
    rest = lines[line - 1][column - 1 :] if lines else ""
    if rest.startswith("\t"):
        return codes.SYNTAX.at(span, problem="a tab is used for indentation", hint="indent with blanks")
    if rest.startswith("{i}") and "expected ',' or" in problem:  # the instance number in a deployment
        hint = 'write "mouth{i}", with quotes'
        return codes.SYNTAX.at(span, problem="a text with {i} must be in quotes inside of brackets", hint=hint)
    if any(part in problem for part in _AFTER_A_MISSING_BLANK):
        found = missing_blank.in_lines(path, lines, line - 1)
        if found is not None:
            return found
    for part, message, hint in _MESSAGES:
        if part in problem:
            fixes = _quotes(span, lines[line - 1], column, part) if lines else ()
            return codes.SYNTAX.at(span, problem=message.format(found=f"'{rest[:1]}'"), hint=hint, fixes=fixes)
    return codes.SYNTAX.at(span, problem=f"this is not YAML: {error.problem or problem}")


def _quotes(span: Span, line: str, column: int, part: str) -> tuple[Fix, ...]:
    """The fix that quotes a text in a block which starts with a reserved character, or a `doc:` that contains ': '."""
    if part == "cannot start any token":
        head, text = line[: column - 1], line[column - 1 :]
        if _BEFORE_A_VALUE.fullmatch(head) is None:
            return ()
    elif part == "mapping values are not allowed" and (doc := _DOC.match(line)) is not None:
        head, text = doc[1], line[doc.end() :]
    else:
        return ()
    text = re.split(r"[ \t]#", text)[0].rstrip()
    if not text or '"' in text or "\\" in text:
        return ()
    edits = tuple(
        Edit(Span(span.file, span.line, at, span.line, at), '"') for at in (len(head) + 1, len(head) + len(text) + 1)
    )
    return (Fix("put it in quotes", edits, True),)
