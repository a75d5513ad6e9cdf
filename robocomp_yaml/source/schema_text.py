"""The text of a kind's JSON Schema: the file in `schemas/`, with its placeholders replaced by the languages.

`"@languages"` in a list is replaced by the names of the languages. In a text, `@languages-or` becomes `python or cpp`,
`@languages-marked` the same with backquotes, `@languages` becomes `python, cpp`, and `@languages-each` the same with
backquotes. `"@snippets"` are the proposals of editors, `"@standards"` and `@standards-or` the numbers of standards.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from functools import cache

from robocomp_yaml import languages, resources
from robocomp_yaml.languages import listed
from robocomp_yaml.languages.record import TargetLanguage

MARKED = frozenset(("cdsl",))
"""The kinds whose files contain placeholders."""


@cache
def schema_text(kind: str, more: tuple[TargetLanguage, ...] = ()) -> str:
    """The JSON Schema of a kind of document, for example 'idsl', as text; `more` are the languages of plug-ins."""
    text = resources.text(f"schemas/{kind}.schema.json")
    return filled(text, [*languages.table().values(), *more]) if kind in MARKED else text


def filled(text: str, known: Iterable[TargetLanguage]) -> str:
    """The text of a schema with the placeholders replaced by these languages."""
    every = list(known)
    names = [one.name for one in every]
    standards = sorted({standard for one in every for standard in one.standards})
    snippets = [json.dumps(snippet, ensure_ascii=False) for one in every for snippet in _snippets(one)]
    for mark, instead in (
        ('"@languages"', ", ".join(map(json.dumps, names))),
        ('"@snippets"', ",\n            ".join(snippets)),
        ('"@standards"', ", ".join(map(str, standards))),
        ("@languages-or", listed(names)),
        ("@languages-marked", listed(f"`{name}`" for name in names)),
        ("@languages-each", ", ".join(f"`{name}`" for name in names)),
        ("@languages", ", ".join(names)),
        ("@standards-or", listed(map(str, standards))),
    ):  # fmt: skip
        text = text.replace(mark, instead)
    return text


def _snippets(language: TargetLanguage) -> Iterator[dict[str, str]]:
    yield {"label": language.name, "description": language.description, "body": language.name}
    if language.standards:
        usual, *rest = map(str, language.standards)
        choice = ",".join((usual, *rest))
        yield {
            "label": f"{language.name} with its standard", "description": f"{language.title}, and which",
            "body": f"{{name: {language.name}, standard: ${{1|{choice}|}}}}",
        }  # fmt: skip
