"""A parser's refusal in words: what was expected, after what, and where the next statement begins."""

from __future__ import annotations

import re
from dataclasses import dataclass

from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedInput, UnexpectedToken
from lark.lexer import PatternStr

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.suggest import suggest
from robocomp_yaml.legacy.reading import Source
from robocomp_yaml.legacy.rules import Rules

_SILENT = re.compile(r'//[^\n]*|/\*[\s\S]*?\*/|#[^\n]*|"(?:[^"\\\n]|\\.)*"')
_WORD = re.compile(r"\w+")
MOST_NAMED = 6


@dataclass(frozen=True, slots=True)
class Fault:
    """`rest` is the text without the statement at fault, as long as before; None: nothing more can be found out."""

    diagnostic: Diagnostic
    rest: str | None


def without_silent(text: str) -> str:
    """The text, as long as before, with blanks for comments, directives and what stands in quotes."""

    def blank(found: re.Match[str]) -> str:
        quoted = found[0][0] == '"'
        return '"' + "_" * (len(found[0]) - 2) + '"' if quoted else re.sub(r"[^\n]", " ", found[0])

    return _SILENT.sub(blank, text)


def explain(error: UnexpectedInput, text: str, source: Source, rules: Rules, lark: Lark) -> Fault:
    bare = without_silent(text)
    at = error.pos_in_stream if error.pos_in_stream is not None else len(text)
    found = str(error.token) if isinstance(error, UnexpectedToken) else text[at : at + 1]
    if isinstance(error, UnexpectedToken) and error.token.type == "$END":
        return Fault(_at_end(error, bare, source, rules, lark), None)
    start, end = _statement(bare, at)
    misplaced = _misplaced_keyword(error, bare, start, lark)
    if misplaced is not None:
        diagnostic = codes.SYNTAX.at(
            source.span(start, start + len(misplaced)), problem=f"'{misplaced}' cannot stand here",
            hint="a '}' is probably missing before it",
        )
    elif not isinstance(error, UnexpectedToken) and found in '"/':
        what = "text in quotes" if found == '"' else "comment"
        diagnostic = codes.SYNTAX.at(source.span(at, at + 1), problem=f"this {what} is never closed", hint="")
    else:
        diagnostic = _unexpected(error, bare, at, found, source, rules, lark)
    rest = None
    if text[start:end].strip():
        rest = text[:start] + re.sub(r"[^\n]", " ", text[start:end]) + text[end:]
    return Fault(diagnostic, rest)


def _unexpected(
    error: UnexpectedInput, bare: str, at: int, found: str, source: Source, rules: Rules, lark: Lark
) -> Diagnostic:
    names = _accepted(error)
    before = bare[:at].rstrip()
    last = re.search(r'\w+\Z|"[^"]*"\Z|\S?\Z', before)
    after = f" after '{source.text[last.start() : len(before)]}'" if last and last[0] else ""
    if "SEMICOLON" in names and "RBRACE" not in names:
        return codes.SYNTAX.at(
            source.span(len(before) - 1, len(before)), problem=f"a ';' is missing{after}", hint=""
        )
    expected = _in_words(names, rules, lark)
    close = suggest(found, [word.strip("'") for word in expected if word.startswith("'") and word[1:2].isalpha()])
    if len(expected) > MOST_NAMED:
        problem = f"'{found}' cannot stand here"
    else:
        problem = f"expected {_either(expected)}{after}, found '{found}'"
    hint = f"did you mean '{close}'?" if close else ""
    return codes.SYNTAX.at(source.span(at, at + max(len(found), 1)), problem=problem, hint=hint)


def _at_end(error: UnexpectedInput, bare: str, source: Source, rules: Rules, lark: Lark) -> Diagnostic:
    end = len(bare.rstrip())
    where = source.span(max(end - 1, 0), end)
    open_: list[int] = []
    for at, char in enumerate(bare):
        if char == "{":
            open_.append(at)
        elif char == "}" and open_:
            open_.pop()
    if open_:
        first = source.span(open_[-1], open_[-1] + 1)
        return codes.SYNTAX.at(
            where, problem="a '}' is missing: the file ends before this block does", hint="",
            related=[Related("the block begins here", first)],
        )
    expected = _either(_in_words(_accepted(error), rules, lark))
    return codes.SYNTAX.at(where, problem=f"the file ends where {expected} is expected", hint="")


def _statement(bare: str, at: int) -> tuple[int, int]:
    """From where to where the statement goes that holds a place: between ';', '{' and '}', with its own blocks."""
    start = max(bare.rfind(char, 0, at) for char in ";{}") + 1
    depth, end = 0, at
    while end < len(bare):
        char = bare[end]
        if char == "}" and depth == 0:
            break
        depth += (char == "{") - (char == "}")
        end += 1
        if depth == 0 and char in ";}":
            break
    if not bare[start:end].strip():  # a '}' too many
        end += 1
    rest = re.compile(r"\s*;").match(bare, end) if bare[end - 1 : end] == "}" else None
    start += len(bare[start:end]) - len(bare[start:end].lstrip())
    return start, rest.end() if rest else end


def _misplaced_keyword(error: UnexpectedInput, bare: str, start: int, lark: Lark) -> str | None:
    """The statement's first word, if it is a keyword that the parser could not take for one there."""
    word = _WORD.match(bare, start)
    keywords = {
        str(terminal.pattern.value).lower() for terminal in lark.terminals if isinstance(terminal.pattern, PatternStr)
    }
    if word is None or word[0].lower() not in keywords:
        return None
    if isinstance(error, UnexpectedToken) and error.token.start_pos == start:
        return word[0] if "RBRACE" in _accepted(error) else None
    stack = error.interactive_parser.parser_state.value_stack if hasattr(error, "interactive_parser") else []
    for value in reversed(stack):
        if isinstance(value, Token) and value.start_pos == start:
            return word[0] if value.type == "NAME" else None
        if isinstance(value, Tree) and not value.meta.empty and value.meta.start_pos == start:
            return word[0]
    return None


def _accepted(error: UnexpectedInput) -> set[str]:
    if isinstance(error, UnexpectedToken):
        return set(error.accepts or error.expected)
    return set(getattr(error, "allowed", ()) or ())


def _in_words(names: set[str], rules: Rules, lark: Lark) -> list[str]:
    """The terminals as a user knows them, in the grammar's order, each once."""
    known: list[str] = []
    for terminal in lark.terminals:
        if terminal.name in names:
            said = str(terminal.pattern.value) if isinstance(terminal.pattern, PatternStr) else terminal.name
            known.append(rules.words.get(terminal.name, f"'{said}'"))
    if "$END" in names:
        known.append(rules.words["$END"])
    return list(dict.fromkeys(known))


def _either(words: list[str]) -> str:
    return " or ".join((", ".join(words[:-1]), words[-1])) if len(words) > 1 else "".join(words)
