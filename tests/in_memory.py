"""Documents that are on no disk, and what is said about them: the shortest way from a text to its meaning."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import msgspec

from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.program import Program
from robocomp_yaml.memory import Memory
from robocomp_yaml.pipeline import Analysis, analyse
from robocomp_yaml.source.tree import Node

ROOT = "/in-memory"
COMPONENT = "component: C\nlanguage: python\n"
_MEMORY = Memory()
"""Documents that many tests have are parsed once."""


class Said(NamedTuple):
    """What is said of a document: `at` is the text to which it points."""

    code: str
    at: str
    message: str
    hint: str = ""
    file: str = ""
    related: tuple[tuple[str, str], ...] = ()
    """Other places, with what is said about them."""


def analysed(documents: Mapping[str, str], *asked: str) -> Analysis:
    """Everything about documents that are given by name; `asked` are those of interest, all where none is named."""
    overlay = {f"{ROOT}/{name}": text.encode() for name, text in documents.items()}
    return analyse([f"{ROOT}/{name}" for name in asked] or [ROOT], overlay=overlay, memory=_MEMORY)


def said(documents: Mapping[str, str], *asked: str) -> list[Said]:
    return [_said(found, documents) for found in analysed(documents, *asked).diagnostics]


def program(documents: Mapping[str, str], *asked: str) -> Program:
    """What documents mean, of which nothing may be wrong."""
    analysis = analysed(documents, *asked)
    assert not analysis.diagnostics, [_said(found, documents) for found in analysis.diagnostics]
    return analysis.program


def _said(found: Diagnostic, documents: Mapping[str, str]) -> Said:
    file, at = _at(found.span, documents)
    related = tuple((plain(one.message), _at(one.span, documents)[1]) for one in found.related)
    return Said(found.code, at, plain(found.message), plain(str(found.hint or "")), file, related)


def plain(text: str) -> str:
    return text.replace(f"{ROOT}/", "").replace(ROOT, ".")


def _at(span: Span, documents: Mapping[str, str]) -> tuple[str, str]:
    file = plain(span.file)
    return file, text_at(documents.get(file, ""), span)


def text_at(text: str, span: Span) -> str:
    lines = text.splitlines()[span.line - 1 : span.end_line]
    if not lines:
        return ""
    lines[-1] = lines[-1][: span.end_column - 1]
    lines[0] = lines[0][span.column - 1 :]
    return "\n".join(lines)


def outline(name: str, it: object, documents: Mapping[str, str], depth: int = 0) -> Iterator[str]:
    """What a document was read as, in lines: each part with the text to which its spans point, where they say more."""
    indent = "  " * depth
    if isinstance(it, tuple | list) and any(isinstance(one, tuple | list | msgspec.Struct) for one in it):
        for one in it:
            yield from outline(name, one, documents, depth)
    elif isinstance(it, Span):
        yield f"{indent}{name}: at `{_short(_at(it, documents)[1])}`"
    elif isinstance(it, msgspec.Struct):
        fields = {one: getattr(it, one) for one in it.__struct_fields__ if one != "path"}
        places = {one: _at(fields.pop(one), documents)[1] for one in list(fields) if isinstance(fields[one], Span)}
        shown = "".join(f", {one} at `{_short(text)}`" for one, text in places.items() if text)
        yield f"{indent}{name}: {type(it).__name__}{shown}"
        for one, value in fields.items():
            if value is not None and value is not False and value not in ("", (), {}):
                yield from outline(one, value, documents, depth + 1)
    else:
        yield f"{indent}{name}: {_short(str(it.data)) if isinstance(it, Node) else repr(it)}"


def _short(text: str) -> str:
    text = " ".join(text.split())
    return text if len(text) < 60 else f"{text[:50]} …"


# Parameters


def pdsl(parameters: str, types: str = "", more: str = "") -> dict[str, str]:
    """A component C with these parameters, in YAML's flow style: `a: int, b: …` stands between braces."""
    kinds = f"types: {{{types}}}\n" if types else ""
    return {
        "c.cdsl.yaml": COMPONENT,
        "c.pdsl.yaml": f"component: c.cdsl.yaml\n{kinds}parameters: {{{parameters}}}\n{more}",
    }


def wrong(parameters: str, types: str = "", more: str = "") -> list[tuple[str, str, str]]:
    """What is said of a document of parameters: code, text, message."""
    return [found[:3] for found in said(pdsl(parameters, types, more), "c.pdsl.yaml")]


def refused(documents: Mapping[str, str], values: str, more: str = "") -> list[str]:
    """What is said of values for the component, which are `complete` as its own are."""
    text = f"component: c.cdsl.yaml\nparameters: {{{values}}}\n{more}"
    return [found.message for found in said({**documents, "c.config.yaml": text}, "c.config.yaml")]


def fitting(documents: Mapping[str, str], candidates: Sequence[str]) -> list[str]:
    """Those values of which nothing is said, each in a document of its own. Of the component nothing may be said."""
    files = {
        f"v{number}.config.yaml": f"component: c.cdsl.yaml\nparameters: {{{values}}}\n"
        for number, values in enumerate(candidates)
    }
    found = {one.file for one in said({**documents, **files})}
    assert found <= set(files), found
    return [values for file, values in zip(files, candidates, strict=True) if file not in found]
