"""Renames one name everywhere: in documents, configurations and the user's code. The result is checked before it is
returned."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial

import msgspec

from robocomp_yaml.diag.diagnostic import ERROR, NOTE, Diagnostic
from robocomp_yaml.diag.errors import NotRenamed
from robocomp_yaml.diag.fix import WORD, Edit
from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.deployment import INDEX
from robocomp_yaml.naming import names as kinds
from robocomp_yaml.naming.analysis import names_of
from robocomp_yaml.naming.in_code import CodeEdit, CodeOfComponent, code_of
from robocomp_yaml.naming.names import DefinedName, Key, Names
from robocomp_yaml.pipeline import Analysis
from robocomp_yaml.source.spelled import DocumentText
from robocomp_yaml.source.text import decode

_FAMILIES = (
    {kinds.INTERFACE, kinds.METHOD, kinds.ARGUMENT}, {kinds.TOPIC, kinds.EVENT, kinds.ARGUMENT},
    {kinds.TYPE, kinds.MEMBER, kinds.ENUMERATOR},
    {kinds.EXCEPTION, kinds.MEMBER}, {kinds.PARAMETER}, {kinds.PARAMETER_TYPE, kinds.PARAMETER_MEMBER},
)  # fmt: skip
_OF_RECORDS = (kinds.MEMBER, kinds.PARAMETER_MEMBER)


class NameEdit(msgspec.Struct, frozen=True):
    """The text in a span becomes another one. `is_code`: it is in the user's code."""

    span: Span
    text: str
    is_code: bool = False


class RenamedTexts(msgspec.Struct, frozen=True):
    """A renaming that was checked: its edits, and the files before and after, by path. `left` are words in the user's
    code that are spelled like the old name, and stay."""

    edits: tuple[NameEdit, ...]
    before: Mapping[str, bytes]
    after: Mapping[str, bytes]
    left: tuple[Span, ...] = ()


def renamed(
    analysis: Analysis,
    names: Names,
    defined: DefinedName,
    name: str,
    analyse: Callable[[Mapping[str, bytes]], Analysis],
    *,
    is_trial: bool = False,
) -> RenamedTexts:
    """The renaming of a name. `analyse` returns the analysis with other contents of some files. Raises NotRenamed
    with the reason, if the name is taken, or the documents would not mean the same. A trial is not judged: only its
    edits matter."""
    if not name or name != name.strip() or "\n" in name:
        raise NotRenamed("a name has at least one character, and no blanks around it")
    if name == defined.name:
        return RenamedTexts((), {}, {})
    if (INDEX in name) != (INDEX in defined.name):
        raise NotRenamed(f"the name of an entry with instances contains {INDEX}, that of any other does not")
    edits = _in_documents(analysis, names, defined, name)
    before = {path: _content(analysis, path) for path in {one.span.file for one in edits}}
    after = {path: _applied(before[path], path, edits) for path in before}
    then = analyse(after)
    if not is_trial:
        _refuse_new(analysis.diagnostics, then.diagnostics)
        _refuse_other_meaning(names, names_of(then), defined, name)
    codes = dict(_codes(analysis))
    in_code: list[NameEdit] = []
    left: list[Span] = []
    for real, code in codes.items():
        linked = then.program.components.get(real)
        if linked is None:
            continue
        made = list(code.edits(linked, partial(_moved, code, defined, name)))
        texts = _texts_after(code, made)
        if not is_trial:
            _refuse_new(code.faults(code.linked, code.texts), code.faults(linked, texts))
            left += _left(code, defined, {one.span for one in made}, names)
        in_code += [NameEdit(replaced(one.span, code), one.text, True) for one in made]
        for path in {one.span.file for one in made}:
            before[code.shown(path)] = code.texts[path].encode()
            after[code.shown(path)] = texts[path].encode()
    return RenamedTexts((*edits, *in_code), before, after, tuple(left))


def replaced(span: Span, code: CodeOfComponent) -> Span:
    return msgspec.structs.replace(span, file=code.shown(span.file))


def _content(analysis: Analysis, path: str) -> bytes:
    raw, _ = analysis.disk.read(path)
    if raw is None:
        raise NotRenamed(f"{path} cannot be read")
    return raw


def _in_documents(analysis: Analysis, names: Names, defined: DefinedName, name: str) -> list[NameEdit]:
    spans = {defined.span, *(one for one in names.uses.get(defined.key, ()) if one not in names.paths)}
    found: dict[Span, NameEdit] = {}
    texts: dict[str, DocumentText] = {}
    for span in sorted(spans):
        if span.file not in texts:
            text = decode(span.file, _content(analysis, span.file))[0]
            texts[span.file] = DocumentText(span.file, text or "")
        own = (defined.name.lower(), name.lower()) if span in names.identities else (defined.name, name)
        for edit in _spelled(texts[span.file], span, *own):
            found[edit.span] = NameEdit(edit.span, edit.text)
    return list(found.values())


def _spelled(text: DocumentText, span: Span, old: str, new: str) -> list[Edit]:
    written = text.text[text.index(span.line, span.column) : text.index(span.end_line, span.end_column)]
    if INDEX in old and old not in written:  # one of several instances
        head, tail = old.split(INDEX, 1)
        number = written[len(head) : len(written) - len(tail)]
        old, new = written, new.replace(INDEX, number)
    if not text.is_yaml:
        return [Edit(span, new)] if written == old else []
    edits = text.spelled(Edit(span, new, WORD, old))
    if not edits:
        raise NotRenamed(f"{span.file}:{span.line}:{span.column}: the name is written in a way that cannot be changed")
    return edits


def _applied(raw: bytes, path: str, edits: Iterable[NameEdit]) -> bytes:
    mark = raw[:3] if raw.startswith(b"\xef\xbb\xbf") else b""
    lines = DocumentText(path, raw.decode("utf-8-sig"))
    return mark + _with(lines, [(one.span, one.text) for one in edits if one.span.file == path]).encode()


def _texts_after(code: CodeOfComponent, edits: Iterable[CodeEdit]) -> dict[str, str]:
    made = dict(code.texts)
    every = [(one.span, one.text) for one in edits]
    for path in {span.file for span, _ in every}:
        made[path] = _with(DocumentText(path, made[path]), [one for one in every if one[0].file == path])
    return made


def _with(lines: DocumentText, edits: Iterable[tuple[Span, str]]) -> str:
    text = lines.text
    for span, new in sorted(edits, reverse=True):
        start, end = lines.index(span.line, span.column), lines.index(span.end_line, span.end_column)
        text = text[:start] + new + text[end:]
    return text


# What is refused


def _refuse_new(before: Iterable[Diagnostic], after: Iterable[Diagnostic]) -> None:
    """Raises NotRenamed if there are diagnostics that there were not before."""
    known = Counter((one.code, one.span.file) for one in before)
    for one in sorted(after, key=lambda one: (one.severity != ERROR, one.sort_key)):
        if one.severity != NOTE and known[one.code, one.span.file] == 0:
            where = f"{os.path.basename(one.span.file)}:{one.span.line}"
            raise NotRenamed(f"{where} would be wrong: {one.message} ({one.code})")
        known[one.code, one.span.file] -= 1


def _refuse_other_meaning(before: Names, after: Names, defined: DefinedName, name: str) -> None:
    """Raises NotRenamed if a name would mean something else."""
    for key, one in before.defined.items():
        now = key_after(key, defined.key, name)
        count = len(before.uses.get(key, ()))
        if now not in after.defined or len(after.uses.get(now, ())) != count:
            raise NotRenamed(f"'{name}' is taken: {one.kind} '{one.name}' would not be the same any more")


def key_after(key: Key, of: Key, name: str) -> Key:
    """A key after a renaming."""
    is_inside = key[0] == of[0] or any({key[0], of[0]} <= family for family in _FAMILIES)
    if len(of) == 2 or not is_inside or key[1 : len(of)] != of[1:]:
        return key  # names of whole documents are not parts of keys
    return (*key[: len(of) - 1], name, *key[len(of) :])


# The user's code


def _codes(analysis: Analysis) -> Iterator[tuple[str, CodeOfComponent]]:
    for real, linked in analysis.program.components.items():
        if linked.broken:
            continue
        found = code_of(linked, os.path.dirname(linked.component.path), analysis.disk)
        if found is not None:
            yield real, found


def _moved(code: CodeOfComponent, defined: DefinedName, name: str, path: str) -> list[tuple[int, int, str]]:
    """What is renamed in the path of a parameter."""
    document = code.linked.parameters.document
    if defined.kind != kinds.PARAMETER or document is None or document.path != defined.key[1]:
        return []
    steps = defined.key[2:]
    parts = path.split(".")
    if tuple(part.partition("[")[0] for part in parts[: len(steps)]) != steps:
        return []
    start = sum(len(part) + 1 for part in parts[: len(steps) - 1])
    return [(start, start + len(steps[-1]), name)]


def _left(code: CodeOfComponent, defined: DefinedName, edited: set[Span], names: Names) -> Iterator[Span]:
    """Words like the old name that stay: the members of records in code have no types that could be followed. Code
    passes arguments by their positions."""
    if not _concerns(code, defined) or defined.kind == kinds.ARGUMENT:
        return
    for span in code.words(defined.name):
        if span not in edited:
            if defined.kind in _OF_RECORDS:
                where = f"{code.shown(span.file)}:{span.line}"
                raise NotRenamed(f"code may use it, which is not followed: {where} has the word '{defined.name}'")
            yield replaced(span, code)


def _concerns(code: CodeOfComponent, defined: DefinedName) -> bool:
    path = defined.key[1]
    document = code.linked.parameters.document
    modules = {scope.module.path for scope in code.linked.modules()}
    return path in modules or path == code.linked.component.path or (document is not None and document.path == path)
