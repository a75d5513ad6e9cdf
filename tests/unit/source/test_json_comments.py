"""Adding members to JSON with comments: everything else stays to the letter."""

from __future__ import annotations

from os.path import commonprefix

import pytest

from robocomp_yaml.source.json_comments import Unreadable, with_members

OURS = {"a.json": ["*.a"]}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("{}", '{\n  "k": {\n    "a.json": [\n      "*.a"\n    ]\n  }\n}'),
        ("{ }\n", '{\n  "k": {\n    "a.json": [\n      "*.a"\n    ]\n  }\n}\n'),
        ('{"x": 1}', '{\n  "k": {\n    "a.json": [\n      "*.a"\n    ]\n  },"x": 1}'),
        (
            '{\n  // mine\n  "x": 1,\n}\n',
            '{\n  "k": {\n    "a.json": [\n      "*.a"\n    ]\n  },\n  // mine\n  "x": 1,\n}\n',
        ),
        ('{"k": {}}', '{"k": {\n    "a.json": [\n      "*.a"\n    ]\n  }}'),
        ('{"k": {"b": 1}}', '{"k": {\n    "a.json": [\n      "*.a"\n    ],"b": 1}}'),
        ('{"k": {/* none */}}', '{"k": {\n    "a.json": [\n      "*.a"\n    ]/* none */}}'),
        ('{"k": {"a.json": "mine"}}', '{"k": {"a.json": "mine"}}'),
    ],
)
def test_members_are_added_and_the_rest_stays(text: str, expected: str) -> None:
    assert with_members(text, "k", OURS) == expected


@pytest.mark.parametrize(
    "text",
    [
        '\ufeff{"x": "// no comment", /* one */ "y": ["a, ]", 1,], }',
        '// head\n{\n  "url": "http://x/*y*/", // tail\n  "k": {"b": "}",},\n}\n',
    ],
)
def test_nothing_but_the_members_is_added(text: str) -> None:
    added = with_members(text, "k", OURS)
    same = len(commonprefix([text, added]))
    assert added.endswith(text[same:]) and '"a.json"' in added
    assert with_members(added, "k", OURS) == added


@pytest.mark.parametrize("text", ["", "{", "[]", '{"k": 3}', "nonsense", "[" * 100_000, '{"x": 1 /* open}'])
def test_what_is_no_such_object_is_left_alone(text: str) -> None:
    with pytest.raises(Unreadable):
        with_members(text, "k", OURS)
