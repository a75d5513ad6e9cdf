"""Names in files of Slice, generated or written by hand, and what they mean in the documents.

A file is read as far as navigation needs it: which word defines or uses a name of which module. A word means a name of
the documents if both are in modules of the same name. Of several documents with such a module, the one counts that is
called like the file, then the first.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Sequence

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.program import Program
from robocomp_yaml.naming import names as kinds
from robocomp_yaml.naming.names import DefinedName, Names
from robocomp_yaml.source.discover import is_skipped
from robocomp_yaml.source.spelled import DocumentText

SUFFIX = ".ice"
_IN_SLICE = (
    kinds.MODULE, kinds.INTERFACE, kinds.TOPIC, kinds.METHOD, kinds.EVENT, kinds.ARGUMENT, kinds.TYPE, kinds.CONSTANT,
    kinds.EXCEPTION, kinds.MEMBER, kinds.ENUMERATOR,
)  # fmt: skip
_MANY = 2000  # files of Slice in a workspace
_TOKEN = re.compile(
    r"//[^\n]*|/\*.*?(?:\*/|\Z)|\"(?:[^\"\\\n]|\\.)*\"?"
    r"|(?P<include>^[ \t]*\#[ \t]*include[ \t]*[<\"](?P<file>[^>\"\n]*)[>\"]?)|^[ \t]*\#[^\n]*"
    r"|(?P<word>\\?[A-Za-z_]\w*(?:\s*::\s*\\?[A-Za-z_]\w*)*)|(?P<mark>[{}();,=<>])",
    re.DOTALL | re.MULTILINE,
)
_PART = re.compile(r"[A-Za-z_]\w*")
_SCOPES = frozenset(("module", "interface", "class", "struct", "exception", "enum"))
_WORDS = frozenset(
    "idempotent out void bool byte short int long float double string Object LocalObject Value throws extends "
    "implements local const sequence dictionary optional tag nonmutating true false".split()
)
_INCLUDE, _MARK = "include", "mark"


class SliceName(msgspec.Struct, frozen=True):
    """A word with the names that it may mean, the nearest first: each with those around it, the module first. The file
    that an `#include` names is the name of a `document`."""

    span: Span
    meanings: tuple[tuple[str, ...], ...] = ()
    document: str = ""


class _Token(msgspec.Struct, frozen=True):
    kind: str
    text: str
    start: int

    @property
    def parts(self) -> list[tuple[str, int, int]]:
        """The names between `::`, with their places."""
        return [(one[0], self.start + one.start(), self.start + one.end()) for one in _PART.finditer(self.text)]


def names_in(path: str, text: str) -> list[SliceName]:
    """The names in a file of Slice. A file with errors has those that can be told."""
    return list(_Reader(DocumentText(path, text)).read())


class _Reader:
    """Reads statement by statement. `scopes` are the scopes around, as pairs of kind and name."""

    def __init__(self, text: DocumentText) -> None:
        self.text = text
        self.scopes: list[tuple[str, str]] = []

    def read(self) -> Iterator[SliceName]:
        statement: list[_Token] = []
        for token in _tokens(self.text.text):
            if token.kind == _INCLUDE:
                stem = os.path.basename(token.text).removesuffix(SUFFIX)
                start = token.start + len(token.text) - len(os.path.basename(token.text))
                yield SliceName(self.text.span(start, start + len(stem)), document=stem)
            elif token.kind == _MARK and token.text in ("{", "}", ";"):
                yield from self._statement(statement, token.text)
                statement = []
            else:
                statement.append(token)
        yield from self._statement(statement, "")

    @property
    def _path(self) -> tuple[str, ...]:
        """The innermost module, and the names in it around the place."""
        modules = [at for at, (kind, _) in enumerate(self.scopes) if kind == "module"]
        return tuple(name for _, name in self.scopes[modules[-1] :]) if modules else ()

    def _statement(self, tokens: list[_Token], end: str) -> Iterator[SliceName]:
        kind = self.scopes[-1][0] if self.scopes else ""
        head = list(_without_tags(tokens[1:] if tokens and tokens[0].text == "local" else tokens))
        if len(head) > 1 and head[0].text in _SCOPES and head[1].kind != _MARK:
            yield from self._defined(head[1])
            for token in head[2:]:
                yield from self._used(token)
            if end == "{":
                self.scopes.append((head[0].text, _plain(head[1])))
        else:
            if kind == "enum":
                yield from self._enumerators(head)
            elif any(token.text == "(" for token in head):
                yield from self._operation(head)
            else:
                yield from self._declared(head)
            if end == "{":
                self.scopes.append(("", ""))
        if end == "}" and self.scopes:
            self.scopes.pop()

    def _enumerators(self, tokens: Sequence[_Token]) -> Iterator[SliceName]:
        is_next = True
        for token in tokens:
            if token.kind == _MARK:
                is_next = token.text == ","
            elif is_next:
                yield from self._defined(token)
                is_next = False
            else:
                yield from self._used(token)

    def _declared(self, tokens: Sequence[_Token]) -> Iterator[SliceName]:
        """A member, a constant, a sequence or a dictionary: its name is the last word before `=`."""
        equals = next((at for at, token in enumerate(tokens) if token.text == "="), len(tokens))
        last = max((at for at in range(equals) if tokens[at].kind != _MARK), default=-1)
        for at, token in enumerate(tokens):
            yield from self._defined(token) if at == last and last > 0 else self._used(token)

    def _operation(self, tokens: Sequence[_Token]) -> Iterator[SliceName]:
        opening = next(at for at, token in enumerate(tokens) if token.text == "(")
        closing = next((at for at in range(opening, len(tokens)) if tokens[at].text == ")"), len(tokens))
        for token in tokens[: max(opening - 1, 0)]:
            yield from self._used(token)
        method = tokens[opening - 1] if opening else None
        if method is not None and method.kind != _MARK:
            yield from self._defined(method)
        for at in range(opening + 1, closing):
            is_last = at + 1 == closing or tokens[at + 1].text == ","
            if is_last and method is not None:
                yield from self._defined(tokens[at], _plain(method))
            else:
                yield from self._used(tokens[at])
        for token in tokens[closing:]:
            yield from self._used(token)

    def _defined(self, token: _Token, *inside: str) -> Iterator[SliceName]:
        if token.kind != _MARK and token.parts:
            name, start, stop = token.parts[-1]
            path = (*self._path, *inside, name)
            yield SliceName(self.text.span(start, stop), (path if path[:-1] else (name,),))

    def _used(self, token: _Token) -> Iterator[SliceName]:
        if token.kind == _MARK or token.text in _WORDS:
            return
        own, parts = self._path[:1], token.parts
        for at, (_, start, stop) in enumerate(parts):
            path = tuple(name for name, _, _ in parts[: at + 1])
            # A name is that of its own module, or begins with its module: `Color::red`, `RoboCompColor::Color`.
            yield SliceName(self.text.span(start, stop), ((*own, *path), path, path[-2:], path[-3:]))


def _without_tags(tokens: Sequence[_Token]) -> Iterator[_Token]:
    """Without `optional(1)`, which may precede a type."""
    is_inside = False
    for token in tokens:
        is_inside = is_inside or token.text in ("optional", "tag")
        if not is_inside:
            yield token
        is_inside = is_inside and token.text != ")"


def _plain(token: _Token) -> str:
    return token.parts[-1][0] if token.parts else ""


def _tokens(text: str) -> Iterator[_Token]:
    for match in _TOKEN.finditer(text):
        if match["include"]:
            yield _Token(_INCLUDE, match["file"], match.start("file"))
        elif match["word"]:
            yield _Token("", match["word"], match.start("word"))
        elif match["mark"]:
            yield _Token(_MARK, match["mark"], match.start("mark"))


class _Meanings:
    """The names of documents by what Slice calls them."""

    def __init__(self, program: Program, names: Names) -> None:
        self._by_path: dict[tuple[str, ...], list[DefinedName]] = {}
        self._by_stem: dict[str, list[DefinedName]] = {}
        self._stems = {linked.module.path: linked.module.stem for linked in program.modules.values()}
        modules = {linked.module.path: linked.module.name for linked in program.modules.values()}
        for one in names.of_kinds(*_IN_SLICE):
            if one.key[1] in modules:
                self._by_path.setdefault((modules[one.key[1]], *one.key[2:]), []).append(one)
                if one.kind == kinds.MODULE:
                    self._by_stem.setdefault(self._stems[one.key[1]], []).append(one)

    def of(self, word: SliceName, stem: str) -> DefinedName | None:
        if word.document:
            return next(iter(self._by_stem.get(word.document, ())), None)
        for path in word.meanings:
            if known := self._by_path.get(path):
                return next((one for one in known if self._stems[one.key[1]] == stem), known[0])
        return None


def meant_in_slice(
    program: Program, names: Names, path: str, text: str, line: int, column: int
) -> tuple[Span, DefinedName] | None:
    """The name of a document that the word at a place in Slice means, with the location of the word."""
    meanings, stem = _Meanings(program, names), _stem(path)
    for word in names_in(path, text):
        if word.span.line == line and word.span.column <= column <= word.span.end_column:
            meant = meanings.of(word, stem)
            if meant is not None:
                return word.span, meant
    return None


def places_in_slice(program: Program, names: Names, one: DefinedName, texts: Iterable[tuple[str, str]]) -> list[Span]:
    """Where files of Slice, by path, have a name of the documents."""
    if one.kind not in _IN_SLICE:
        return []
    meanings: _Meanings | None = None
    found = []
    stem = next((each.module.stem for each in program.modules.values() if each.module.path == one.key[1]), "")
    for path, text in texts:
        if one.name not in text and not (one.kind == kinds.MODULE and stem in text):
            continue  # most files have nothing to do with it
        meanings = meanings or _Meanings(program, names)
        own = _stem(path)
        found += [word.span for word in names_in(path, text) if meanings.of(word, own) == one]
    return found


def files_of_slice(root: str, more: Iterable[str]) -> Iterator[str]:
    """The files of Slice of a workspace, and in `more` folders; beside a document that is in none, those in its
    folder."""
    found: dict[str, None] = {}
    is_folder = os.path.isdir(root)
    for top in (root if is_folder else os.path.dirname(root), *more):
        for where, folders, files in os.walk(top):
            folders[:] = sorted(name for name in folders if is_folder and not is_skipped(name))
            found.update({os.path.realpath(os.path.join(where, name)): None for name in files if name.endswith(SUFFIX)})
            if len(found) > _MANY:
                break
    yield from sorted(found)[:_MANY]


def _stem(path: str) -> str:
    return os.path.basename(path).removesuffix(SUFFIX)
