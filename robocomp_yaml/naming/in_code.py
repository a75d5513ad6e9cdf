"""Names in the user's code, after the documents were renamed.

What code can use of its worker is a tree of offers, made from the documents: in the same order before and after a
renaming. So the two trees, side by side, say which name in code has become which, in every language.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping

import msgspec

from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.layout import SOURCES
from robocomp_yaml.emit.usage import check
from robocomp_yaml.emit.usage.check import UserSources
from robocomp_yaml.emit.usage.code import MODULES, WORKER, Chain, CodeUsage, Word
from robocomp_yaml.emit.usage.offer import Offer, WorkerOffer
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.spelled import DocumentText
from robocomp_yaml.transactions.output_root import Root

Moved = Callable[[str], list[tuple[int, int, str]]]
"""What is renamed in the path of a parameter: start, end and new text of each part."""


class CodeEdit(msgspec.Struct, frozen=True):
    """The text in a span of a file below src/ becomes another one."""

    span: Span
    text: str


class CodeOfComponent:
    """The code of a component. `texts` are its files, by their paths below src/; `shown` makes paths for users."""

    def __init__(self, linked: LinkedComponent, root: Root, found: UserSources) -> None:
        self.linked, self.root, self.texts = linked, root, found.texts
        self._has_usage = linked.component.language.target.has_usage
        self._part = linked.component.language.target.part("usage") if self._has_usage else None

    def shown(self, path: str) -> str:
        return self.root.shown(f"{SOURCES}/{path}")

    def faults(self, linked: LinkedComponent, texts: Mapping[str, str]) -> list[Diagnostic]:
        """The diagnostics about the code, if it were this one."""
        return list(check.check(linked, self.root, UserSources(dict(texts)))) if self._has_usage else []

    def edits(self, after: LinkedComponent, moved: Moved) -> Iterator[CodeEdit]:
        """The edits that follow a change of names in documents, each once. Raises Refused if the code has errors of
        syntax."""
        if self._part is None:
            return
        old, new = self._part.offer(self.linked), self._part.offer(after)
        usage: CodeUsage = self._part.read(self.texts, self.linked, old)
        if usage.faults and old != new:
            text, at = usage.faults[0]
            raise Refused(f"{self.shown(at.file)}:{at.line}:{at.column}: {text}: this code cannot be renamed")
        found: dict[Span, str] = {}
        for chain in usage.chains:
            for word, text in _in_chain(chain, old, new, moved):
                if self._text_at(word.span) == word.text:
                    found.setdefault(word.span, text)
        mine = usage.own - {word.text for word in usage.methods}
        whole = {before: to for before, to in _generated(old, new).items() if before not in mine}
        for to in whole.values():
            if (taken := next(self.words(to), None)) is not None:
                raise Refused(f"{self.shown(taken.file)}:{taken.line}:{taken.column}: the code has a '{to}' already")
        for path, text in self.texts.items():
            lines = DocumentText(path, text)
            for before, to in whole.items():
                for place in re.finditer(rf"\b{re.escape(before)}\b", text):
                    found[lines.span(*place.span())] = to
        yield from (CodeEdit(span, text) for span, text in sorted(found.items()))

    def _text_at(self, span: Span) -> str:
        text = DocumentText(span.file, self.texts.get(span.file, ""))
        return text.text[text.index(span.line, span.column) : text.index(span.end_line, span.end_column)]

    def words(self, word: str) -> Iterator[Span]:
        """Where a word is in the code."""
        for path, text in self.texts.items():
            lines = DocumentText(path, text)
            for place in re.finditer(rf"\b{re.escape(word)}\b", text):
                yield lines.span(*place.span())


def code_of(linked: LinkedComponent, folder: str, disk: Disk) -> CodeOfComponent | None:
    """The code of a component; None if there is none, or none that can be read."""
    language = linked.component.language.target
    if not language.suffixes or not disk.has_folder(f"{folder}/{SOURCES}" if folder else SOURCES):
        return None
    root = Root(folder)
    found = check.sources(root, language.suffixes, disk, {})
    return CodeOfComponent(linked, root, found) if found is not None and found.texts else None


def _pairs(old: Collection[str], new: Collection[str]) -> dict[str, str]:
    """The names that changed, each with the new one. Both are in the same order."""
    if len(old) != len(new):
        return {}
    return {one: other for one, other in zip(old, new, strict=True) if one != other}


def _generated(old: WorkerOffer, new: WorkerOffer) -> dict[str, str]:
    """Names that mean the same in the whole code: modules, and what rcyaml makes for the worker, which is proxies,
    methods of interfaces and handlers of states."""
    made = {
        one: other for one, other in _pairs(old.roots[WORKER].members, new.roots[WORKER].members).items() if "_" in one
    }
    for one, other in zip(old.served, new.served, strict=False):
        made |= _pairs(one.methods, other.methods)
    modules = _pairs(old.roots[MODULES].members, new.roots[MODULES].members)
    return made | modules | _pairs(old.handlers, new.handlers)


def _in_chain(chain: Chain, old: WorkerOffer, new: WorkerOffer, moved: Moved) -> Iterator[tuple[Word, str]]:
    """The names in a chain that changed."""
    before: Offer | None = old.roots.get(chain.root)
    after: Offer | None = new.roots.get(chain.root)
    states = _pairs(old.states, new.states)
    for step in chain.steps:
        if before is None or after is None:
            return
        if step.is_index:
            before, after = before.element, after.element
            continue
        name = step.word.text
        member = before.members.get(name)
        if member is None:
            yield from _beside(step.word, before, after)
            return
        changed = _pairs(before.members, after.members)
        if name in changed:
            yield step.word, changed[name]
        arguments = step.arguments
        if arguments is not None and arguments.text is not None and member.is_state:
            if arguments.text.text in states:
                yield arguments.text, states[arguments.text.text]
        if arguments is not None and member.takes_path:
            for word in (*((arguments.text,) if arguments.text else ()), *arguments.keys):
                text = word.text
                for start, end, to in sorted(moved(text), reverse=True):
                    text = text[:start] + to + text[end:]
                if text != word.text:
                    yield word, text
        before, after = member.value, after.members[changed.get(name, name)].value


_VARIANT = re.compile(r"(begin_|end_)(\w+)|(\w+?)(Async)")


def _beside(word: Word, before: Offer, after: Offer) -> Iterator[tuple[Word, str]]:
    """Ice's variants of an operation: `begin_say`, `sayAsync`."""
    changed = _pairs(before.members, after.members)
    found = _VARIANT.fullmatch(word.text)
    name = (found[2] or found[3]) if found else ""
    if found and name in changed:
        yield word, f"{found[1] or ''}{changed[name]}{found[4] or ''}"
