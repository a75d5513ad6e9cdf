"""Components use only what their language has."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from robocomp_yaml import languages
from robocomp_yaml.diag.codes import cdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.languages.record import CAPABILITIES, STANDARD, TargetLanguage
from robocomp_yaml.link.program import Program
from robocomp_yaml.model.component import Component


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in program.components.values():
        component = linked.component
        language = component.language.target
        for key, span in _used(component):
            if key in language.ignored:
                yield codes.OTHER_LANGUAGE.at(span, language=language.title, key=key)
            elif key not in language.has:
                more = program.plugins_of(component.path).languages
                yield codes.NOT_AVAILABLE.at(
                    span,
                    key=key,
                    language=language.title,
                    hint=_hint(key, language, more),
                    related=[Related(f"the component's language is {language.title}", component.language.span)],
                )


def _used(component: Component) -> Iterator[tuple[str, Span]]:
    """The capabilities that a document uses, with their spans."""
    for key, span in component.keys_span:
        if key in CAPABILITIES:
            yield key, span
    if component.language.standard is not None:
        yield STANDARD, component.language.standard_span
    for source in component.sources:
        yield source.kind, source.span
    for library in component.libraries:
        yield library.kind, library.span


def _hint(key: str, language: TargetLanguage, more: Iterable[TargetLanguage]) -> str:
    others = languages.listed(other.title for other in languages.with_capability(key, more))
    has = languages.listed((one for one in CAPABILITIES if one in language.has), "and")
    return f"remove it, or write the component in {others}; {language.title} has {has}"
