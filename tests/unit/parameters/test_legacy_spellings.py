"""How properties of old configs spell parameters: which spellings can be, which values they can say, and both ways."""

from __future__ import annotations

from pathlib import Path

import pytest

from conftest import write_tree
from in_memory import pdsl, said
from robocomp_yaml.source import properties

PARAMETERS = (
    "n: {type: int, default: 0}, first: {type: M, optional: true}, ms: {list: M, default: []}, "
    "ls: {list: string, default: []}, ll: {list: {list: string}, default: []}, "
    "deep: {list: {list: {list: int}}, default: []}, map: {map: int, default: {}}, "
    "maps: {list: {map: int}, default: []}, g: {group: {x: {type: int, default: 0}}}, "
    "odd: {list: O, default: []}"
)
TYPES = (
    "M: {struct: {name: string, id: int, most: {type: float, default: 1.5}, "
    "tag: {type: string, optional: true}}}, O: {struct: {many: {list: int}, a: int}}"
)


def spelled(legacy: str) -> dict[str, str]:
    return pdsl(PARAMETERS, TYPES, f"legacy: {{{legacy}}}\n")


@pytest.mark.parametrize(
    "legacy",
    [
        "g.x: G",
        "ms: {key: X, separators: [';', ','], columns: [name, id]}",
        "ls: {key: 'a b{i}'}",
        "period.compute: Period",
    ],
)
def test_a_spelling_that_can_be(legacy: str) -> None:
    assert said(spelled(legacy), "c.pdsl.yaml") == []


@pytest.mark.parametrize(
    ("legacy", "at", "problem", "hint"),
    [
        ('n: {key: N, count: C}', 'n', 'is for rows, and the parameter is one plain value', ''),
        ("n: 'N{i}'", 'n', 'is for rows, and the parameter is one plain value', ''),
        ('n: {key: N, columns: [a]}', 'n', 'is for rows, and the parameter is one plain value', ''),
        ('nn: N', 'nn', 'names an unknown parameter', "did you mean 'n'?"),
        ('g: G', 'g', "is for a group: spell the members of the group, such as period.compute", ''),
        ('first: {key: First}', 'first', "needs 'columns': the members in a row, in order", ''),
        ("first: {key: 'F{i}', columns: [name, id]}", 'first', 'is for a list, and the parameter is one record', ''),
        ('first: {key: First, columns: [name]}', 'first', "omits 'id', which has no default", ''),
        ('first: {key: First, columns: [name, nme]}', 'first', "names unknown member 'nme' of M", ''),
        ('first: {key: First, columns: [name, id], count: C}', 'first', 'is for a list, and the parameter is one record', ''),
        ('ms: {key: M, columns: [name, id]}', 'ms', "needs the row number {i} in its key, or 'separators' for a list in one property", ''),
        ("ms: {key: 'M{i}'}", 'ms', "needs 'columns': the members in a row, in order", ''),
        ("ms: {key: 'M{i}', columns: [name, idd]}", 'ms', "names unknown member 'idd' of M", ''),
        ("ms: {key: 'M{i}', columns: [name]}", 'ms', "omits 'id', which has no default", ''),
        ("ms: {key: 'M{i}{name}', columns: [name, id]}", 'ms', "has 'name' both in the key and in the columns", ''),
        ("ms: {key: 'M{name}', columns: [id], count: C}", 'ms', "has no row number {i}, so it cannot have 'count'", ''),
        ("ms: {key: 'M{i}{j}', columns: [name, id]}", 'ms', "names unknown member 'j' of M", ''),
        ("ms: {fields: {name: 'n{i}', idd: 'i{i}'}}", 'ms', "names unknown member 'idd' of M", ''),
        ("ms: {fields: {name: 'n{i}'}}", 'ms', "omits 'id', which has no default", ''),
        ("ms: {fields: {name: 'n{i}', id: 'i{i}{i}'}}", 'ms', "needs {i} once in the property of 'id'", ''),
        ("ms: {key: X, separators: [';']}", 'ms', "needs 'columns': the members in a row, in order", ''),
        ("ms: {key: X, separators: [';'], columns: [name, id]}", 'ms', 'needs 2 separators, one for each level', ''),
        ("ls: {key: 'L{i}', columns: [a]}", 'ls', 'has columns, and the elements are not records', ''),
        ("ls: {key: 'L{x}'}", 'ls', 'has placeholders other than {i}, and the elements are not records', ''),
        ("ls: {fields: {a: 'l{i}'}}", 'ls', "has 'fields', and the elements are not records", ''),
        ("ls: {key: L, separators: [';', ',']}", 'ls', 'needs 1 separator, one for each level', ''),
        ("ls: {key: 'L{i}', separators: [';']}", 'ls', "has 'separators' for one property, so it cannot have {i} or 'count'", ''),
        ("ls: {key: L, separators: [';'], count: C}", 'ls', "has 'separators' for one property, so it cannot have {i} or 'count'", ''),
        ("ls: {key: L, separators: [';'], columns: [a]}", 'ls', 'has columns, and the elements are not records', ''),
        ("ll: {key: 'L{i}'}", 'll', 'cannot nest lists or maps in rows', ''),
        ("ll: {key: L, separators: [';']}", 'll', 'needs 2 separators, one for each level', ''),
        ("deep: {key: L, separators: [';', ',']}", 'deep', 'needs 3 separators, one for each level', ''),
        ("map: {key: 'M{i}'}", 'map', "is for a map, and maps are spelled by their paths", ''),
        ('map: M', 'map', "is for a map, and maps are spelled by their paths", ''),
        ("maps: {key: M, separators: [';', ',']}", 'maps', 'cannot nest maps in one property', ''),
        ("odd: {key: 'O{i}', columns: [many, a]}", 'odd', "has 'many' in a row, which is not a plain value", ''),
        ("odd: {fields: {many: 'm{i}', a: 'a{i}'}}", 'odd', "has 'many' as a field, which is not a plain value", ''),
        ('ls: {}', 'ls', "has neither 'key' nor 'fields'", ''),
        ("ls: {key: 'L{i'}", 'ls', "needs the row number {i} in its key, or 'separators' for a list in one property", ''),
        ("ls: {key: 'L}'}", 'ls', "needs the row number {i} in its key, or 'separators' for a list in one property", ''),
    ],
)  # fmt: skip
def test_a_spelling_that_cannot_be(legacy: str, at: str, problem: str, hint: str) -> None:
    (found,) = said(spelled(legacy), "c.pdsl.yaml")
    assert found[:2] == ("RC3121", at) and found.message.endswith(f"' {problem}") and found.hint == hint


def faults(legacy: str, values: str) -> list[tuple[str, str]]:
    text = f"component: c.cdsl.yaml\nparameters: {{{values}}}\n"
    return [(one.at, one.message) for one in said({**spelled(legacy), "c.config.yaml": text}, "c.config.yaml")]


@pytest.mark.parametrize(
    ("legacy", "values", "at", "message"),
    [
        ("ms: {key: 'M{i}', columns: [name, id, most, tag]}", "ms: [{name: 'a,b', id: 1}]", "{name: 'a,b', id: 1}", "ms[0] cannot be a property of Ice: its row, 'a,b,1,1.5', would be read differently"),
        ("ms: {key: 'M{i}', columns: [name, id, most, tag]}", "ms: [{name: ' a', id: 1}]", "{name: ' a', id: 1}", "ms[0] cannot be a property of Ice: its row, ' a,1,1.5', would be read differently"),
        ("ms: {key: 'M{name}', columns: [id]}", 'ms: [{name: a, id: 1}, {name: a, id: 2}]', '{name: a, id: 2}', 'ms[1] cannot be a property of Ice: another row already uses the property Ma'),
        ("ms: {key: 'M{name}', columns: [id]}", "ms: [{name: '', id: 1}]", "{name: '', id: 1}", 'ms[0] cannot be a property of Ice: its key, M, would be read differently'),
        ("ms: {key: 'M{name}', columns: [id]}", 'ms: [{name: a, id: 1, most: 3}]', '3', 'ms[0].most cannot be a property of Ice: its rows have no column for it'),
        ("ms: {key: 'M{name}', columns: [id]}", 'ms: [{name: a, id: 1, tag: t}]', 't', 'ms[0].tag cannot be a property of Ice: its rows have no column for it'),
        ("ls: {key: L, separators: [',']}", "ls: ['a,b']", "['a,b']", "ls cannot be a property of Ice: its separators cannot spell 'a,b'"),
        ("ls: {key: L, separators: [',']}", "ls: ['']", "['']", "ls cannot be a property of Ice: its separators cannot spell ''"),
        ("ls: {key: L, separators: [',']}", "ls: ['a ', b]", "['a ', b]", "ls cannot be a property of Ice: its separators cannot spell 'a ,b'"),
        ("ll: {key: L, separators: [';', ',']}", "ll: [['a;b']]", "[['a;b']]", "ll cannot be a property of Ice: its separators cannot spell 'a;b'"),
        ("ll: {key: L, separators: [';', ',']}", 'll: [[]]', '[[]]', "ll cannot be a property of Ice: its separators cannot spell ''"),
        ("ls: {key: 'L{i}'}", "ls: ['']", "''", 'ls[0] cannot be a property of Ice: its row would be empty'),
        ("ls: {key: 'L{i}'}", "ls: [a, '']", "''", 'ls[1] cannot be a property of Ice: its row would be empty'),
        ("ls: {key: 'L{i}'}", 'ls: ["a\\nb"]', '"a\\nb"', 'ls[0] cannot be a property of Ice: it contains a line end'),
        ("ms: {fields: {name: 'n{i}', id: 'i{i}'}}", 'ms: [{name: a, id: 1, most: 3}]', '3', 'ms[0].most cannot be a property of Ice: its rows have no property for it'),
        ('n: N', "ls: ['${env:X}']", "'${env:X}'", 'ls[0] cannot be a property of Ice: it would be read as a reference to the environment'),
    ],
)  # fmt: skip
def test_a_value_that_a_spelling_cannot_say(legacy: str, values: str, at: str, message: str) -> None:
    assert (at, message) in faults(legacy, values)


@pytest.mark.parametrize(
    ("legacy", "values"),
    [
        ("ms: {key: 'M{i}', columns: [name, id, most, tag]}", 'ms: [{name: a, id: 1, tag: t}]'),
        ("ms: {key: 'M{i}', columns: [name, id, most, tag]}", "ms: [{name: '', id: 1}]"),
        ("ms: {key: 'M{i}', columns: [name, id, most, tag]}", 'ms: [{name: {env: X}, id: 1}]'),
        ("ms: {key: 'M{name}', columns: [id]}", "ms: [{name: 'x y', id: 1}]"),
        ("ls: {key: L, separators: [',']}", 'ls: []'),
        ("ls: {key: L, separators: [',']}", "ls: [a, '']"),
        ("ll: {key: L, separators: [';', ',']}", 'll: [[a], []]'),
        ("ll: {key: L, separators: [';', ',']}", 'll: [[a, b], [c]]'),
        ("ms: {fields: {name: 'n{i}', id: 'i{i}'}}", "ms: [{name: '', id: 1}]"),
        ('n: N', "map: {'': 1}"),
        ('n: N', 'map: {a.b: 1}'),
        ('n: N', "map: {'a b': 1}"),
        ('n: N', 'map: {size: 1}'),
        ('n: N', 'map: {keys: 1}'),
        ('n: N', 'map: {"a\\nb": 1}'),
        ('n: N', 'ls: ["a\\tb"]'),
        ('n: N', "ls: ['a\\\\']"),
        ('n: N', "ls: [' a']"),
        ('n: N', "ls: ['#']"),
        ('n: N', 'll: [[], [a]]'),
    ],
)  # fmt: skip
def test_a_value_that_can_be_said(legacy: str, values: str) -> None:
    assert faults(legacy, values) == []


SPELLINGS = (
    'n: N, first: {key: First, columns: [id, name]}, ms: {key: "M{i}", first: 1, columns: [name, id, most, tag], '
    'separator: "; ", count: Count}, ls: {key: Names, separators: [","], trailing: true}, '
    'll: {key: Pairs, separators: [";", ","]}'
)


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ("n: 5", {"N": "5"}),
        ("first: {name: a, id: 1}", {"First": "1,a"}),
        ("ms: [{name: a, id: 1}]", {"Count": "1", "M1": "a; 1; 1.5"}),
        ("ms: [{name: a, id: 1, most: 2.5, tag: t}, {name: b, id: 2}]", {"Count": "2", "M1": "a; 1; 2.5; t", "M2": "b; 2; 1.5"}),
        ("ls: [a, b]", {"Names": "a,b,"}),
        ("ll: [[a, b], [c]]", {"Pairs": "a,b;c"}),
        ("g: {x: 3}", {"g.x": "3"}),
        ("map: {left: 1, 'a b': 2}", {"map.keys": "left a%20b", "map.left": "1"}),
        ("deep: [[[1], [2, 3]]]", {"deep.size": "1", "deep.0.size": "2", "deep.0.0.0": "1", "deep.0.1.1": "3"}),
    ],
)  # fmt: skip
def test_what_a_value_is_as_properties_and_back(
    rcyaml: object, tmp_path: Path, values: str, expected: dict[str, str]
) -> None:
    """A flat config that a component has is taken over by its first document of values."""
    documents = pdsl(PARAMETERS, TYPES, f"legacy: {{{SPELLINGS}}}\n")
    write_tree(tmp_path, {**documents, "etc/config.yaml": f"component: ../c.cdsl.yaml\nparameters: {{{values}}}\n"})
    flat = rcyaml("config", "export", "etc/config.yaml", "--as", "ice").stdout  # type: ignore[operator]
    held = properties.read(flat).values
    assert {key: held.get(key) for key in expected} == expected, held
    (tmp_path / "etc/config.yaml").unlink()
    write_tree(tmp_path, {"etc/config": flat})
    assert rcyaml("config", "new", "c.cdsl.yaml").exit_code == 0  # type: ignore[operator]
    again = properties.read(rcyaml("config", "export", "etc/config.yaml", "--as", "ice").stdout).values  # type: ignore[operator]
    assert {key: again.get(key) for key in held} == held
