"""Diagnostics about the user's class: missing methods, with the text to paste, and outdated and obsolete methods."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import cache
from typing import TYPE_CHECKING, cast

from msgspec.structs import replace

from robocomp_yaml.diag.codes import specific as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import suggest
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.emit.specific import config_merge
from robocomp_yaml.emit.specific.code import CLASS, SourceCode, SourceMethod
from robocomp_yaml.emit.specific.compare import (
    Comparison,
    MissingMethod,
    ObsoleteMethod,
    accepted_in,
    behind_errors,
    compare,
)
from robocomp_yaml.emit.specific.insert import lead
from robocomp_yaml.emit.specific.reading import code_in, comment_mark, is_code, others, read, signature_types
from robocomp_yaml.emit.specific.types import Differ
from robocomp_yaml.emit.specific.user_file import UserFile
from robocomp_yaml.transactions.output_root import Root

if TYPE_CHECKING:
    from robocomp_yaml.link.program import LinkedComponent


def report(
    root: Root, files: Sequence[UserFile], document: str, linked: LinkedComponent | None = None
) -> Iterator[Diagnostic]:
    """The diagnostics about the user's files of the component of a document."""
    merge = f"paste the following, or insert it with `{typed('rcyaml', 'compile', '--merge', document)}`"
    code = [file for file in files if file.is_text and is_code(file.path)]
    if any(not file.is_up_to_date for file in code):
        yield from _about_class(root, code, merge, _differ(root, code, linked))
    for file in files:
        if config_merge.is_config(file.path) and file.is_text and not file.is_up_to_date:
            if keys := config_merge.missing(file.base, file.yours, file.new):
                path = root.shown(file.path)
                more = config_merge.paste(file.new, keys).rstrip("\n")
                yield codes.MISSING_PROPERTIES.at(Span(path), path=path, keys=", ".join(keys), more=more, hint=merge)


def _differ(root: Root, files: Sequence[UserFile], linked: LinkedComponent | None) -> Differ:
    """Compares types of the component's language, if it can be done."""

    @cache
    def types() -> Differ:
        read_types = signature_types(files[0].path) if linked is not None else None
        if linked is None or read_types is None:
            return lambda mine, expected, is_result: False
        folders = {file.path.rpartition("/")[0] for file in files}
        texts = [data.decode(errors="replace") for folder in sorted(folders) for _, data in code_in(root, folder)]
        converts = bool(linked.component.compatibility)
        return cast("Differ", read_types(linked, texts, converts=converts).differ)

    return lambda mine, expected, is_result: mine != expected and types()(mine, expected, is_result)


def _about_class(root: Root, files: Sequence[UserFile], merge: str, differ: Differ) -> Iterator[Diagnostic]:
    new = [code for file in files if (code := read(file.path, file.new))]
    base = {file.path: code for file in files if file.base and (code := read(file.path, file.base))}
    yours = [code for file in files if (code := read(file.path, file.yours))]
    for code in yours:
        if code.older is not None:
            command = f"`2to3 -w {typed(root.shown(code.path))}` converts it (Python 3.12 and older have 2to3)"
            yield codes.OLDER_LANGUAGE.at(_span(root, code, code.older), path=root.shown(code.path), hint=command)
    if any(code.older is not None for code in yours):
        return  # a grammar of today sees other blocks in it, so that methods are missing which are there
    accepted = accepted_in(code for file in files if (code := read(file.path, file.accepted)))
    comparison = compare(new, base, yours, accepted=accepted, differ=differ, hidden=behind_errors(yours))
    if comparison.missing or not any(code.location for code in yours):
        # Other files may contain parts of the class.
        yours += others(root, {file.path for file in files})
        comparison = compare(new, base, yours, accepted=accepted, differ=differ, hidden=behind_errors(yours))
    home = next((code for code in yours if code.location), None)
    if home is None or home.location is None:
        homes = {code.path for code in new if code.location}
        where = next((code for code in yours if code.path in homes), yours[0])
        yield codes.NO_CLASS.at(Span(root.shown(where.path)), name=CLASS, path=root.shown(where.path))
        return
    expected = next((one for code in new for one in code.bases), "")
    if expected and _lacks(expected, yours):
        yield codes.NO_BASE.at(
            _span(root, home, home.location), name=CLASS, base=expected, hint=f"derive it from {expected}"
        )
    if comparison.missing:
        names = list(dict.fromkeys(one.method.name for one in comparison.missing))
        more = _paste(comparison.missing, yours)
        span = _span(root, home, home.location)
        yield codes.MISSING_METHODS.at(span, name=CLASS, methods=", ".join(names), more=more, hint=merge)
    yield from _about_methods(root, comparison)


def _lacks(expected: str, yours: Sequence[SourceCode]) -> bool:
    """Whether the class is derived from nothing, or from a misspelled base that the code names nowhere else."""
    bases = [re.split(r"[.:]", base)[-1] for code in yours if code.location is not None for base in code.bases]
    if not bases:
        return True
    words = Counter(word for code in yours for line in code.lines for word in re.findall(r"\w+", line))
    return (
        len(bases) == 1 and bases[0] != expected and words[bases[0]] == 1 and suggest(bases[0], [expected]) is not None
    )


def _about_methods(root: Root, comparison: Comparison) -> Iterator[Diagnostic]:
    for one in comparison.outdated:
        yield codes.OUTDATED.at(
            _span(root, one.code, one.method.location), name=one.method.name, more=_head(one.skeleton, one.expected),
            hint="it must begin as follows",
        )  # fmt: skip
    for method in comparison.obsolete:
        first, *rest = (_span(root, code, one.location) for code, one in method.occurrences)
        yield codes.OBSOLETE.at(
            first, name=method.name, related=[Related("also here", location) for location in rest],
            hint=f"was it renamed to '{method.renamed}'?" if method.renamed else _own(method),
        )  # fmt: skip


def _own(method: ObsoleteMethod) -> str:
    """The hint for a method that no interface has, and that overrides nothing any more."""
    texts = (code.text_of(one) for code, one in method.occurrences)
    words = [word for text in texts for word in ("@Override", "override") if re.search(rf"(?<!\w){word}\b", text)]
    return f"remove it, or keep it as your own{f', without {words[0]}' if words else ''}"


def _span(root: Root, code: SourceCode, word: Span) -> Span:
    return replace(word, file=root.shown(code.path))


def _paste(lacking: Sequence[MissingMethod], yours: Sequence[SourceCode]) -> str:
    """The text to paste, file by file."""
    parts: list[str] = []
    skeletons = list({one.skeleton.path: one.skeleton for one in lacking}.values())
    mine = {line.strip() for code in yours for line in code.lines}
    for skeleton in skeletons:
        known = {one.key for code in yours if code.path == skeleton.path for one in code.imports}
        parts += [one.line for one in skeleton.imports if one.key not in known]
        if len(skeletons) > 1:
            parts.append(f"{comment_mark(skeleton.path)} in {skeleton.path}:\n")
        for one in lacking:
            if one.skeleton is skeleton:
                title = lead(skeleton, one.method)
                if title and title.splitlines()[0].strip() not in mine and title not in parts:
                    parts.append(title)
                parts.append(skeleton.text_of(one.method) + ("\n" if one.method.has_body else ""))
    return "".join(parts).rstrip("\n")


def _head(skeleton: SourceCode, method: SourceMethod) -> str:
    """The lines of a method before its body."""
    lines = skeleton.lines[method.first : method.end]
    for n, line in enumerate(lines):
        if line.rstrip().endswith((":", ";", "{")) or (n and line.strip() == "{"):
            return "".join(lines[: n if line.strip() == "{" else n + 1]).rstrip("\n")
    return "".join(lines).rstrip("\n")
