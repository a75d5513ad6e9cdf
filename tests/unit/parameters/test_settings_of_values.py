"""The properties of a values document that are no parameters: by Ice's names, with the layers that they come from."""

from __future__ import annotations

from msgspec.structs import replace

from parameters import linked, values
from robocomp_yaml.parameters.layers.settings import settings


def test_each_section_has_its_spelling_and_extensions_are_no_connections() -> None:
    given = values(
        linked({"parameters": {}}), {}, endpoints={"A": "tcp -p 1", "x-note": "b"}, proxies={"B": "b:tcp -p 2"},
        topics={"manager": "IceStorm/T:tcp -p 9", "prefix": {"News": "r"}, "name": {"News": "n", "Old": None}},
        ice={"x-y": "1"}, properties={"Own": "5"},
    )  # fmt: skip
    assert [(one.section, one.name, one.key, one.node.lexeme) for one in settings(given)] == [
        ("endpoints", "A", "A.Endpoints", "tcp -p 1"),
        ("proxies", "B", "BProxy", "b:tcp -p 2"),
        ("topics", "manager", "TopicManager.Proxy", "IceStorm/T:tcp -p 9"),
        ("topics", "News", "Proxies.NewsPrefix", "r"),
        ("topics", "News", "News", "n"),
        ("ice", "x-y", "Ice.x-y", "1"),
        ("properties", "Own", "Own", "5"),
    ]


def test_null_in_a_later_layer_removes_one_and_another_text_replaces_it() -> None:
    of = linked({"parameters": {}})
    first = values(of, {}, properties={"a": "1", "b": "2", "c": "3"}, topics={"manager": "m"})
    second = replace(values(of, {}, properties={"a": None, "b": "4"}, topics={"manager": None}), extends=(first,))
    third = replace(values(of, {}, properties={"a": "6", "b": "7"}), extends=(second,))
    found = [(one.key, one.node.lexeme, [node.data for node in one.overrode]) for one in settings(third)]
    assert sorted(found) == [("a", "6", []), ("b", "7", ["4", "2"]), ("c", "3", [])]
