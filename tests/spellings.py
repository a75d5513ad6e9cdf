"""A parameter of each legacy spelling, and properties for them: all readers must read these alike."""

from __future__ import annotations

from typing import Any

DOCUMENT: dict[str, Any] = {
    "types": {"Motor": {"struct": {
        "name": "string", "id": {"type": "int", "default": 7}, "tag": {"type": "string", "optional": True},
        "gain": {"type": "float", "optional": True},
    }}},
    "parameters": {"spelled": {"group": {
        "name": {"type": "string", "optional": True}, "id": {"type": "int", "optional": True},
        "motors": {"list": "Motor", "default": []}, "counted": {"list": "Motor", "default": []},
        "cams": {"list": "Motor", "default": []}, "one": {"type": "Motor", "optional": True},
        "table": {"list": "Motor", "default": []}, "keyed": {"list": "Motor", "default": []},
        "ids": {"list": "string", "default": []}, "words": {"list": {"list": "string"}, "default": []},
        "plain": {"list": "Motor", "default": []}, "sizes": {"map": "Motor", "default": {}},
    }}},
    "legacy": {
        "spelled.name": "name", "spelled.id": "id",
        "spelled.motors": {"key": "M{i}", "first": 1, "columns": ["name", "id", "tag", "gain"]},
        "spelled.counted": {"key": "C{i}", "columns": ["name", "tag"], "count": "Count"},
        "spelled.cams": {"fields": {"name": "name_{i}", "tag": "tag_{i}"}, "count": "Cams"},
        "spelled.one": {"key": "One", "columns": ["name", "gain"], "separator": ";"},
        "spelled.table": {"key": "Table", "separators": [";", ","], "columns": ["name", "tag"]},
        "spelled.keyed": {"key": "ID:{name}-{id}", "columns": ["tag", "gain"]},
        "spelled.ids": {"key": "Id{i}", "count": "Ids"},
        "spelled.words": {"key": "Words", "separators": [";", ","], "trailing": True},
    },
}  # fmt: skip
_A: dict[str, Any] = {"name": "a", "id": 7}

# Properties, and the values that they give; None where they are refused.
CASES: list[tuple[dict[str, str], dict[str, Any] | None]] = [
    # Optional columns at a row's end may be left out; others may not, and there may not be more than there are.
    ({"M1": "a,3,t,0.5"}, {"motors": [{"name": "a", "id": 3, "tag": "t", "gain": 0.5}]}),
    ({"M1": "a,3,t"}, {"motors": [{"name": "a", "id": 3, "tag": "t"}]}),
    ({"M1": "a,3", "M2": "b,4,,2"}, {"motors": [{"name": "a", "id": 3}, {"name": "b", "id": 4, "gain": 2}]}),
    ({"M1": "a,,"}, {"motors": [_A]}),
    ({"M1": "a"}, None),
    ({"M1": "a,3,t,0.5,1"}, None),
    ({"One": "a"}, {"one": _A}),
    ({"One": "a;2"}, {"one": {**_A, "gain": 2}}),
    ({"One": "a;2;3"}, None),
    ({"Table": "a;b,t"}, {"table": [_A, {"name": "b", "id": 7, "tag": "t"}]}),
    ({"Table": "a,t,u"}, None),
    ({"ID:x-3": "t", "ID:b-2": ",1"}, {"keyed": [
        {"name": "b", "id": 2, "gain": 1}, {"name": "x", "id": 3, "tag": "t"}]}),
    # A row that the count promises and that has no property is an empty one; other properties are none of its business.
    ({"Count": "2", "C0": "a,t", "name": "top", "id": "5"}, {
        "name": "top", "id": 5, "counted": [{**_A, "tag": "t"}, {"name": "", "id": 7}]}),
    ({"Cams": "1", "name": "top", "id": "5"}, {"name": "top", "id": 5, "cams": [{"name": "", "id": 7}]}),
    ({"Cams": "1", "C{i}.name": "x", "tag_0": "t"}, {"cams": [{"name": "", "id": 7, "tag": "t"}]}),
    ({"Ids": "3", "Id1": "x"}, {"ids": ["", "x", ""]}),
    ({"Count": "0", "C0": "a"}, {}),
    ({"Count": "-1"}, None),
    ({"Count": "two"}, None),
    ({"Count": "9" * 5000}, None),
    ({"Ids": "1000002"}, None),
    ({"spelled.plain.size": "9" * 5000}, None),
    ({"Words": "a, b;c;"}, {"words": [["a", "b"], ["c"]]}),
    ({"spelled.plain.size": "2", "spelled.plain.0.name": "a"}, {"plain": [_A, {"name": "", "id": 7}]}),
    ({"spelled.plain.1.id": "2"}, {}),
    ({"spelled.sizes.keys": "a b", "spelled.sizes.b.id": "1"}, {
        "sizes": {"a": {"name": "", "id": 7}, "b": {"name": "", "id": 1}}}),
    ({"ID:a-" + "9" * 5000: ""}, None),
    ({"ID:a-1": "", "ID:a-" + "9" * 5000: ""}, None),
]  # fmt: skip
