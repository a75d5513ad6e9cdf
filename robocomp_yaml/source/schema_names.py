"""The schemas of a workspace's editors: those of the package, with the names of the workspace and with examples that
are offered as examples.

A subschema with `x-names: KIND` is a place for names of that kind. Its editor completes them; other names are right as
well, because a name may be in another folder, or in a document that is not saved yet. Only a slip of the keyboard is
marked: a name with two letters of a known one exchanged.
"""

from __future__ import annotations

from collections.abc import Iterator
from collections.abc import Mapping as Map
from functools import cache, lru_cache
from typing import Any

import msgspec

from robocomp_yaml.grouping import grouped
from robocomp_yaml.languages.record import TargetLanguage
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source.schema_text import schema_text
from robocomp_yaml.source.yaml_text import scalar, text_of

MARK = "x-names"
_CHECKED = frozenset(("imports", "interfaces", "topics", "ports"))
"""The kinds whose slips are marked. Hosts and entries belong to one deployment, and may be as similar as `p12` and
`p21`."""

_SPECIAL = pattern(r"[\\$}]")  # in the text of a snippet


class OfferedName(msgspec.Struct, frozen=True, order=True):
    """A name as it is written, and what it is."""

    text: str
    says: str = ""


OfferedNames = tuple[tuple[str, tuple[OfferedName, ...]], ...]
"""The names of each kind, in alphabetical order."""


@lru_cache(maxsize=32)
def schema_with(names: OfferedNames, kind: str, more: tuple[TargetLanguage, ...] = ()) -> str:
    """The JSON Schema of a kind of document as text, with these names; `more` are the languages of plug-ins."""
    schema = msgspec.json.decode(schema_text(kind, more))
    known = {of: offered for of, offered in names if offered}
    used: set[str] = set()
    _fill(schema, known, used)
    for of in sorted(used):
        schema["definitions"][f"{MARK}-{of.replace(' ', '-')}"] = _definition(of, known[of])
    return msgspec.json.format(msgspec.json.encode(schema), indent=1).decode() + "\n"


def offered_in(schema: Any) -> frozenset[str]:
    """The names that a schema of a workspace offers."""
    definitions = schema.get("definitions", {}) if isinstance(schema, dict) else {}
    lists = [one["defaultSnippets"] for name, one in definitions.items() if name.startswith(f"{MARK}-")]
    return frozenset(snippet["label"] for snippets in lists for snippet in snippets)


def with_examples(kind: str) -> dict[str, Any]:
    """A copy of the JSON Schema of a kind of document, without names; its examples are offered as examples."""
    schema: dict[str, Any] = msgspec.json.decode(_text_with_examples(kind))
    return schema


@cache
def _text_with_examples(kind: str) -> bytes:
    schema = msgspec.json.decode(schema_text(kind))
    _fill(schema, {}, set())
    return msgspec.json.encode(schema)


def _fill(schema: Any, known: Map[str, object], used: set[str], around: str = "") -> None:
    """Changes a subschema to what is written. `around` is the kind of names of the subschema that contains it in
    `allOf`."""
    if isinstance(schema, list):
        for item in schema:
            _fill(item, known, used, around)
    if not isinstance(schema, dict):
        return
    kind, examples = schema.pop(MARK, ""), schema.get("examples")
    for key, value in schema.items():
        if isinstance(value, (dict, list)) and key not in ("examples", "enum", "defaultSnippets"):
            _fill(value, known, used, kind if key == "allOf" else "")
    more: list[dict[str, Any]] = []
    if kind in known:
        used.add(kind)
        more.append({"$ref": f"#/definitions/{MARK}-{kind.replace(' ', '-')}"})
    if isinstance(examples, list) and "enum" not in schema and any(isinstance(example, str) for example in examples):
        del schema["examples"]
        only_hovered = {"if": {}, "then": {"examples": examples, "allOf": [{}]}}
        more.append({"title": schema["title"], **only_hovered} if "title" in schema else only_hovered)
        if (kind or around) not in known:
            schema["defaultSnippets"] = [*_as_examples(examples), *schema.get("defaultSnippets", ())]
    if more:
        schema["allOf"] = [*schema.get("allOf", ()), *more]


def _as_examples(examples: list[Any]) -> Iterator[dict[str, str]]:
    for example in examples:
        if isinstance(example, (list, dict, bool)):
            continue  # true and false are completed as what they are
        text = text_of(example, in_flow=True) if isinstance(example, str) else scalar(example)
        yield {"label": f"for example {example}", "description": "an example", "body": f"${{1:{_escaped(text)}}}"}


def _definition(kind: str, names: tuple[OfferedName, ...]) -> dict[str, Any]:
    made: dict[str, Any] = {
        "title": "Name",
        "defaultSnippets": [
            {"label": one.text, "description": one.says, "body": _escaped(text_of(one.text, in_flow=True))}
            for one in names
        ],
    }
    if kind in _CHECKED:
        made |= _checked([one.text for one in names])
    return made


def _checked(names: list[str]) -> dict[str, Any]:
    """A subschema that rejects slips of these names, with the name that is meant."""
    known = set(names)
    slips = {name: sorted(set(_slips(name)) - known) for name in names}
    meant = grouped((slip, name) for name, wrong in slips.items() for slip in wrong)
    certain = {slip: names[0] for slip, names in meant.items() if len(names) == 1}
    if not certain:
        return {}
    rules = [
        {
            "if": {"enum": [slip for slip in wrong if slip in certain]},
            "then": {"type": "null", "errorMessage": f"did you mean '{name}'?"},
        }
        for name, wrong in slips.items()
        if any(slip in certain for slip in wrong)
    ]  # fmt: skip
    return {"if": {"type": "string", "enum": sorted(certain)}, "then": {"allOf": rules}}


def _slips(name: str) -> Iterator[str]:
    """A name with two neighbouring letters exchanged, at least one of them small. Short names are too similar."""
    for index in range(len(name) - 1 if len(name) > 4 else 0):
        one, two = name[index], name[index + 1]
        if one.lower() != two.lower() and one.isalpha() and two.isalpha() and (one + two) != (one + two).upper():
            yield name[:index] + two + one + name[index + 2 :]


def _escaped(text: str) -> str:
    return _SPECIAL.sub(r"\\\g<0>", text)
