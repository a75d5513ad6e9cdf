"""Explain a syntax error: what was expected, after which token, and where the next statement starts."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any

import msgspec
from lark import Token, Tree
from lark.exceptions import UnexpectedInput, UnexpectedToken

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.fix import Hint
from robocomp_yaml.diag.suggest import meaning, suggest
from robocomp_yaml.legacy.reading import SourceText
from robocomp_yaml.legacy.rules import Rules

_BRACE_HINT = "a '}' is probably missing before it"
MOST_NAMED = 6

_SILENT = re.compile(r'//[^\n]*|/\*[\s\S]*?\*/|#[^\n]*|"(?:[^"\\\n]|\\.)*"')
_LAST = re.compile(r'(?:\w+|"[^"]*"|\S)\Z')


class SyntaxFault(msgspec.Struct, frozen=True):
    """`rest` is the text with the faulty statement blanked; None where no further error can be found."""

    diagnostic: Diagnostic
    rest: str | None
    at_end: bool = False


def without_silent(text: str) -> str:
    """Return a text of the same length, with blanks for comments and directives, and '_' for text in quotes."""

    def blank(found: re.Match[str]) -> str:
        quoted = found[0][0] == '"'
        return '"' + "_" * (len(found[0]) - 2) + '"' if quoted else re.sub(r"[^\n]", " ", found[0])

    return _SILENT.sub(blank, text)


class SyntaxExplainer:
    """Explains a syntax error in a text: the source's, in which statements may be blanked."""

    def __init__(self, source: SourceText, rules: Rules, literals: Mapping[str, str], text: str) -> None:
        self.source, self.rules, self.literals, self.text = source, rules, literals, text
        self.bare = without_silent(text)

    def explain(self, error: UnexpectedInput) -> SyntaxFault:
        if isinstance(error, UnexpectedToken) and error.token.type == "$END":
            return SyntaxFault(self._at_end(error), None, at_end=True)
        at = error.pos_in_stream or 0
        start, end = self._statement(at)
        depth = self.bare.count("{", 0, start) - self.bare.count("}", 0, start)
        rest = None
        if depth > 0 and self.text[start:end].strip():
            rest = self.text[:start] + re.sub(r"[^\n]", " ", self.text[start:end]) + self.text[end:]
        return SyntaxFault(self._diagnostic(error, at, start, depth), rest)

    def _diagnostic(self, error: UnexpectedInput, at: int, start: int, depth: int) -> Diagnostic:
        keyword = self._misplaced_keyword(error, start) if depth > 0 else None
        if keyword is not None:
            return self._diagnostic_at(
                start, start + len(keyword), f"'{keyword}' is not allowed here", _BRACE_HINT, missing="}"
            )
        if isinstance(error, UnexpectedToken):
            return self._unexpected(error, at, str(error.token))
        char = self.text[at]
        if char == '"' or self.text.startswith("/*", at):
            what = "text in quotes" if char == '"' else "comment"
            return self._diagnostic_at(at, at + 1, f"this {what} is not closed")
        return self._diagnostic_at(at, at + 1, f"'{char}' is not allowed here")

    def _unexpected(self, error: UnexpectedToken, at: int, found: str) -> Diagnostic:
        names = set(error.accepts or error.expected)
        before = self.bare[:at].rstrip()
        within = before[-1:] not in (";", "{", "}", "")
        last = _LAST.search(before)
        after = f" after '{self.source.text[last.start() : len(before)]}'" if last else ""
        if within and "SEMICOLON" in names and "RBRACE" not in names:
            return self._diagnostic_at(len(before) - 1, len(before), f"a ';' is missing{after}")
        expected = self._in_words(names if within else names - {"SEMICOLON"})
        if len(expected) > MOST_NAMED and within:
            expected = [word for word in expected if not word.strip("'").isalpha()]
        words = [self.literals[name] for name in names if self.literals.get(name, "").isalpha()]
        close = suggest(found, sorted(words))
        if not expected or len(expected) > MOST_NAMED:
            problem = f"'{found}' is not allowed here"
        else:
            problem = f"expected {_either(expected)}{after}, found '{found}'"
        return self._diagnostic_at(at, at + len(found), problem, meaning(found, close) if close else "")

    def _at_end(self, error: UnexpectedToken) -> Diagnostic:
        end = len(self.bare.rstrip())
        open_: list[int] = []
        for at, char in enumerate(self.bare):
            if char == "{":
                open_.append(at)
            elif char == "}" and open_:
                open_.pop()
        if open_:
            begin = Related("the block starts here", self.source.span(open_[-1], open_[-1] + 1))
            problem = "a '}' is missing: the file ends inside of this block"
            return self._diagnostic_at(end - 1, end, problem, related=[begin])
        expected = _either(self._in_words(set(error.accepts or error.expected) - {"SEMICOLON"}))
        return self._diagnostic_at(max(end - 1, 0), end, f"the file ends where {expected} is expected")

    def _diagnostic_at(
        self, start: int, end: int, problem: str, hint: str | Hint = "", related: Iterable[Related] = (), **facts: Any
    ) -> Diagnostic:
        return codes.SYNTAX.at(self.source.span(start, end), problem=problem, hint=hint, related=related, **facts)

    def _statement(self, at: int) -> tuple[int, int]:
        """Return the start and end of the statement around a position: between ';', '{' and '}', with its own
        blocks."""
        bare = self.bare
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
        if not bare[start:end].strip():  # a superfluous '}'
            end += 1
        semicolon = re.compile(r"\s*;").match(bare, end) if bare[end - 1 : end] == "}" else None
        start += len(bare[start:end]) - len(bare[start:end].lstrip())
        return start, semicolon.end() if semicolon else end

    def _misplaced_keyword(self, error: UnexpectedInput, start: int) -> str | None:
        """Return the statement's first word, if it is a keyword that the grammar does not allow at that position."""
        word = re.compile(r"\w+").match(self.bare, start)
        if word is None or word[0].lower() not in {literal.lower() for literal in self.literals.values()}:
            return None
        if isinstance(error, UnexpectedToken) and error.token.start_pos == start:
            return word[0] if "RBRACE" in (error.accepts or error.expected) else None
        parser = getattr(error, "interactive_parser", None)
        for value in reversed(parser.parser_state.value_stack if parser is not None else []):
            if isinstance(value, Token) and value.start_pos == start:
                return word[0] if value.type == "NAME" else None
            if isinstance(value, Tree) and not value.meta.empty and value.meta.start_pos == start:
                return word[0]
        return None

    def _in_words(self, names: set[str]) -> list[str]:
        """Return the names of terminals for messages, each once; `''` in the rules' `words` hides a terminal."""
        words = [self.rules.words.get(name, f"'{self.literals.get(name, name)}'") for name in sorted(names)]
        return sorted({word for word in words if word}, key=lambda word: (word[0] == "'", word))


def _either(words: list[str]) -> str:
    return " or ".join((", ".join(words[:-1]), words[-1])) if len(words) > 1 else "".join(words)
