"""The JSON Schemas themselves: valid, complete as teachers, and of one opinion whichever library reads them."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema
import jsonschema_rs
import pytest

from robocomp_yaml.source import tree
from robocomp_yaml.source.schema import validate
from robocomp_yaml.source.schema_text import schema_text

KINDS = ("idsl", "cdsl", "pdsl", "ddsl", "config", "workspace", "mock")
EDITOR = Path(__file__).resolve().parents[2] / "editor"
RIGHT = {
    "idsl": "Speech.idsl.yaml",
    "cdsl": "speech.cdsl.yaml",
    "pdsl": "speech.pdsl.yaml",
    "config": "speech.config.yaml",
    "ddsl": "robot.ddsl.yaml",
    "workspace": "rcyaml.yaml",
    "mock": "robot.mock.yaml",
}
SCHEMAS: dict[str, dict[str, Any]] = {kind: json.loads(schema_text(kind)) for kind in KINDS}
ANNOTATIONS = ("title", "description", "markdownDescription")


def subschemas(schema: Any, path: str = "#") -> Iterator[tuple[str, dict[str, Any]]]:
    """Every subschema with its path; examples, snippets and names of keys are none."""
    if not isinstance(schema, dict):
        return
    yield path, schema
    for key in ("if", "then", "else", "not", "items", "additionalProperties", "propertyNames"):
        yield from subschemas(schema.get(key), f"{path}/{key}")
    for key in ("allOf", "anyOf", "oneOf"):
        for index, value in enumerate(schema.get(key, ())):
            yield from subschemas(value, f"{path}/{key}/{index}")
    for key in ("properties", "patternProperties", "definitions"):
        for name, value in schema.get(key, {}).items():
            yield from subschemas(value, f"{path}/{key}/{name}")


ALL = [(f"{kind}{path[1:]}", kind, sub) for kind in KINDS for path, sub in subschemas(SCHEMAS[kind])]
CONSTRUCTS = [row for row in ALL if "title" in row[2]]


def resolved(kind: str, schema: dict[str, Any]) -> dict[str, Any]:
    return SCHEMAS[kind]["definitions"][schema["$ref"].rpartition("/")[2]] if "$ref" in schema else schema


def within(kind: str, part: dict[str, Any]) -> jsonschema.Draft7Validator:
    """A validator of a part, with the definitions that it refers to."""
    return jsonschema.Draft7Validator({**part, "definitions": SCHEMAS[kind]["definitions"]})


def read(text: str) -> Any:
    root, said = tree.parse("document.yaml", text)
    assert root is not None, said
    return root.data


@pytest.mark.parametrize("kind", KINDS)
def test_it_is_a_schema_of_draft_07(kind: str) -> None:
    assert SCHEMAS[kind]["$schema"] == "http://json-schema.org/draft-07/schema#"
    jsonschema.Draft7Validator.check_schema(SCHEMAS[kind])


@pytest.mark.parametrize("kind", KINDS)
def test_every_definition_is_used_and_nothing_lies_outside(kind: str) -> None:
    refs = {sub["$ref"] for _, of, sub in ALL if of == kind and "$ref" in sub}
    assert refs == {f"#/definitions/{name}" for name in SCHEMAS[kind]["definitions"]}


def test_a_reference_stands_alone() -> None:
    """Draft-07 ignores what stands beside `$ref`, and editors do not."""
    assert [path for path, _, sub in ALL if "$ref" in sub and len(sub) > 1] == []


def test_every_key_teaches() -> None:
    for path, kind, sub in ALL:
        keys = [*sub.get("properties", {}).items(), *sub.get("patternProperties", {}).items()]
        keys.append(("additionalProperties", sub.get("additionalProperties")))
        for key, value in keys:
            if isinstance(value, dict):
                assert set(ANNOTATIONS) <= set(resolved(kind, value)), f"{path}: {key}"


@pytest.mark.parametrize(("path", "kind", "construct"), CONSTRUCTS, ids=lambda value: value if value in KINDS else "")
def test_every_construct_has_examples_or_values_that_fit(path: str, kind: str, construct: dict[str, Any]) -> None:
    """An editor shows them on hover; those of a mapping or list stand in its `then`."""
    if construct["title"] == "Extension":
        return
    examples = list(construct.get("enum", ()))
    snippets = list(construct.get("defaultSnippets", ()))
    branch: Any = construct
    while isinstance(branch, dict):
        branch = resolved(kind, branch)
        examples += branch.get("examples", ())
        snippets += [s for option in branch.get("anyOf", ()) for s in option.get("defaultSnippets", ())]
        examples += resolved(kind, branch.get("then", {})).get("examples", ())
        branch = branch.get("else")
    assert examples or snippets, path
    for example in examples:
        assert list(within(kind, construct).iter_errors(example)) == [], (path, example)


def test_every_snippet_fits_where_it_is_offered() -> None:
    """Behind a key the body is the whole value; inside of a mapping it may lack keys that are still to come."""
    for path, kind, sub in ALL:
        for option in sub.get("anyOf", ()):
            for snippet in option.get("defaultSnippets", ()):
                errors = list(within(kind, sub).iter_errors(body(snippet["body"])))
                assert errors == [], (path, snippet)
        for snippet in sub.get("defaultSnippets", ()):
            assert set(snippet) == {"label", "description", "body"}
            if "anyOf" not in path:
                errors = [e for e in within(kind, sub).iter_errors(body(snippet["body"])) if e.validator != "required"]
                assert errors == [], (path, snippet)


def body(snippet: Any) -> Any:
    """A snippet's body as the value that it becomes: placeholders by their defaults, texts read as YAML."""
    if isinstance(snippet, dict):
        return {plain(key): body(value) for key, value in snippet.items()}
    return read(plain(snippet)) if isinstance(snippet, str) else snippet


def plain(text: str) -> str:
    text = re.sub(r"\$\{\d+\|([^,|]*)[^|]*\|\}", r"\1", text)
    return re.sub(r"\$\{\d+:([^{}]*)\}", r"\1", text)


@pytest.mark.parametrize(("path", "kind", "sub"), [r for r in ALL if "errorMessage" in r[2]], ids=lambda v: "")
def test_a_message_is_only_where_it_is_right_for_every_fault(path: str, kind: str, sub: dict[str, Any]) -> None:
    """It would hide which key is missing, or not allowed."""
    if "required" in sub:
        assert set(sub) == {"required", "errorMessage"} and len(sub["required"]) == 1, path
    assert not {"additionalProperties", "allOf", "anyOf"} & set(sub) or "if" in sub, path
    if "properties" in sub:
        assert forbids(sub), path


def forbids(sub: dict[str, Any]) -> bool:
    """Whether a part only says which keys cannot stand there."""
    return all(value is False for value in sub["properties"].values())


def test_alternatives_never_refuse() -> None:
    """`anyOf` only carries snippets: as a rule it gives messages that nobody understands."""
    for path, _, sub in ALL:
        assert not {"oneOf", "not"} & set(sub), path
        assert sub.get("anyOf", [{}])[-1] == {}, path


@pytest.mark.parametrize("kind", KINDS)
def test_extensions_are_allowed_in_every_mapping(kind: str) -> None:
    for path, of, sub in ALL:
        if of == kind and sub.get("properties") and not forbids(sub):
            assert list(sub["patternProperties"]) == ["^x-"] and sub["additionalProperties"] is False, path


@pytest.mark.parametrize("kind", KINDS)
def test_right_documents_fit(kind: str) -> None:
    document = read((EDITOR / "documents" / RIGHT[kind]).read_text(encoding="utf-8"))
    assert [error.message for error in jsonschema.Draft7Validator(SCHEMAS[kind]).iter_errors(document)] == []
    assert jsonschema_rs.Draft7Validator(SCHEMAS[kind]).is_valid(document)


@pytest.mark.parametrize("kind", KINDS)
def test_both_libraries_say_the_same_of_every_mutation(kind: str) -> None:
    """Each value of the right document is replaced by odd ones, each key is dropped: same faults at the same places."""
    slow, fast = jsonschema.Draft7Validator(SCHEMAS[kind]), jsonschema_rs.Draft7Validator(SCHEMAS[kind])
    document = read((EDITOR / "documents" / RIGHT[kind]).read_text(encoding="utf-8"))
    tried = 0
    for mutant in mutants(document):
        tried += 1
        expected = {tuple(error.absolute_path) for error in slow.iter_errors(mutant)}
        assert {tuple(error.instance_path) for error in fast.iter_errors(mutant)} == expected, mutant
        assert fast.is_valid(mutant) == (not expected), mutant
    assert tried > 50


ODD = (None, "a name", {"a b": 1, "doc": 3})


def mutants(value: Any) -> Iterator[Any]:
    if isinstance(value, dict):
        for key in value:
            for new in (*ODD, *mutants(value[key])):
                yield {**value, key: new}
            yield {k: v for k, v in value.items() if k != key}
        yield {**value, "unknown key": 1}
    elif isinstance(value, list):
        for index, old in enumerate(value):
            for new in (*ODD, *mutants(old)):
                yield [*value[:index], new, *value[index + 1 :]]


@pytest.mark.parametrize(
    ("kind", "text"),
    [
        ("ddsl", "deployment: R\ncomponents: {a: {program: TEXT}}\n"),
        ("ddsl", "deployment: R\ncomponents: {a: {program: x, cwd: TEXT, endpoints: {A: tcp -p 1}}}\n"),
        ("ddsl", "deployment: R\ncomponents: {a: {program: x, endpoints: {A: TEXT}}}\n"),
        ("ddsl", "deployment: R\ncomponents: {a: {program: x, connect: {A: TEXT}}}\n"),
        ("ddsl", "deployment: R\ncomponents: {a: {component: TEXT}}\n"),
        ("ddsl", "deployment: R\ncomponents: {a: {component: x, executable: TEXT}}\n"),
        ("ddsl", "deployment: R\ncomponents: {a: {program: x, ready: {log: TEXT}}}\n"),
        ("ddsl", "deployment: R\ninclude: [TEXT]\n"),
        ("cdsl", "component: C\nlanguage: python\nparameters: TEXT\n"),
        ("cdsl", "component: C\nlanguage: python\nimports: [TEXT]\n"),
        ("config", "extends: [TEXT]\n"),
        ("pdsl", "component: TEXT\n"),
        ("pdsl", "parameters: {a: {type: int, unit: TEXT}}\n"),
        ("idsl", "module: M\nimports: [TEXT]\n"),
        ("workspace", "interfaces: [TEXT]\n"),
    ],
)
def test_texts_of_one_line(kind: str, text: str) -> None:
    for sign in "\n\r\0\v\f\x1b\x7f\x85\u2028\u2029":
        root, _ = tree.parse("x", text.replace("TEXT", json.dumps(f"a{sign}b").replace("\x7f", "\\x7f")))
        assert root is not None
        (fault,) = (found for found in validate(kind, root) if found.code == "RC0209")
        assert f"U+{ord(sign):04X}" in fault.message and fault.span.line == text.count("\n", 0, text.index("TEXT")) + 1
    root, _ = tree.parse("x", text.replace("TEXT", '"a é😀 b"'))
    assert root is not None and "RC0209" not in [found.code for found in validate(kind, root)]


def test_arguments_and_variables_hold_all_but_nul() -> None:
    texts = "args: [TEXT], env: {A: TEXT}, ready: {command: [TEXT]}"
    for sign, count in (("\n", 0), ("\x1b", 0), ("\u2028", 0), ("\0", 3)):
        text = f"deployment: R\ncomponents: {{a: {{program: x, {texts}}}}}\n".replace("TEXT", json.dumps(f"a{sign}"))
        root, _ = tree.parse("x", text)
        assert root is not None
        assert [found.code for found in validate("ddsl", root)] == ["RC0209"] * count
