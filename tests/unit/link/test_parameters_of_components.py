"""Parameters in documents: types by name, groups, editable, optional and secret parameters, and `period`."""

from __future__ import annotations

import pytest

from in_memory import ROOT, pdsl, program, refused, said
from robocomp_yaml.parameters.types import RecordType, ResolvedMember, is_secret


def parameters(flow: str, types: str = "", component: str = "") -> dict[str, ResolvedMember]:
    """Every parameter by its path, those of groups behind a dot."""
    documents = pdsl(flow, types)
    documents["c.cdsl.yaml"] += component
    linked = program(documents).components[f"{ROOT}/c.cdsl.yaml"].parameters
    assert linked is not None
    return dict(_opened(linked.parameters.root, ""))


def _opened(record: RecordType, before: str) -> list[tuple[str, ResolvedMember]]:
    found = []
    for member in record.members:
        found.append((f"{before}{member.name}", member))
        if isinstance(member.type, RecordType):
            found += _opened(member.type, f"{before}{member.name}.")
    return found


def names(found: dict[str, ResolvedMember], what: str) -> str:
    return " ".join(path for path, member in found.items() if getattr(member, what) and path[:6] != "period")


@pytest.mark.parametrize(
    ("flow", "editable"),
    [
        ("a: int", ""),
        ("a: {type: int, editable: true}, b: int", "a"),
        ("g: {editable: true, group: {x: int, y: int}}", "g g.x g.y"),
        ("g: {editable: true, group: {x: int, y: {type: int, editable: false}}}", "g g.x"),
        ("g: {group: {x: int, y: {type: int, editable: true}}}", "g.y"),
        ("g: {editable: true, group: {h: {group: {x: int}}, i: {editable: false, group: {y: int}}}}", "g g.h g.h.x"),
        ("g: {editable: false, group: {h: {editable: true, group: {x: int}}}}", "g.h g.h.x"),
    ],
)
def test_members_inherit_editable_from_their_group(flow: str, editable: str) -> None:
    assert names(parameters(flow), "editable") == editable


@pytest.mark.parametrize(
    ("flow", "required"),
    [
        ("a: int, b: {type: int, default: 1}, c: {type: int, optional: true}", "a"),
        ("g: {group: {x: int, y: {type: int, default: 1}}}", "g g.x"),
        ("g: {group: {y: {type: int, default: 1}}}, h: {group: {z: {type: int, optional: true}}}", ""),
    ],
)
def test_parameters_without_default_that_are_not_optional_are_required(flow: str, required: str) -> None:
    assert names(parameters(flow), "required") == required


@pytest.mark.parametrize(
    ("flow", "types", "secret"),
    [
        ("a: string, b: {type: string, secret: true}", "", "b"),
        ("password: string, api-key: {list: string, as: key}, token: int", "", "password api-key token"),
        ("passwords: {map: string}", "", "passwords"),
        ("has_password: bool, b: {type: E, secret: true}", "E: {enum: [x, y]}", "b"),
        ("b: {list: {list: string}, secret: true}", "", "b"),
        ("credentials: {group: {user: string, n: int, on: bool}}", "", "credentials.user credentials.n"),
        ("g: {group: {password: string, x: int}}", "", "g.password"),
    ],
)
def test_a_parameter_is_secret_by_its_name_or_by_its_key(flow: str, types: str, secret: str) -> None:
    found = parameters(flow, types)
    assert " ".join(path for path, member in found.items() if is_secret(member.type)) == secret


@pytest.mark.parametrize(
    ("flow", "component", "compute", "emergency"),
    [
        ("a: int", "", 100, 500),
        ("a: int", "period: 20\n", 20, 500),
        ("period: {group: {compute: {type: int, default: 30}}}", "", 30, 500),
        ("period: {group: {compute: {type: int, default: 30}}}", "period: 30\n", 30, 500),
        ("period: {group: {compute: int}}", "", 100, 500),
        ("period: {group: {compute: int}}", "period: 20\n", 20, 500),
        ("period: {group: {emergency: {type: int, default: 7}}}", "period: 20\n", 20, 7),
        ("period: {group: {compute: {type: int, optional: true}}}", "", None, 500),
        ("period: {group: {draw: {type: int, default: 1}}}", "", 100, 500),
    ],
)
def test_each_component_has_its_periods(flow: str, component: str, compute: int | None, emergency: int) -> None:
    found = parameters(flow, component=component)
    defaults = [found[f"period.{name}"].default for name in ("compute", "emergency")]
    assert [one and one.data for one in defaults] == [compute, emergency]
    assert list(found)[-1].startswith("period."), "behind all others"
    assert ("period.draw" in found) == ("draw" in flow)


def test_default_periods_are_positive_milliseconds_and_editable() -> None:
    found = parameters("a: int")
    assert found["period"].editable and found["period.compute"].editable and found["period.compute"].unit == "ms"
    assert refused(pdsl("a: int"), "a: 1, period: {compute: 0, emergency: -1}") == [
        "period.compute is 0 ms, and must be at least 1 ms",
        "period.emergency is -1 ms, and must be at least 1 ms",
    ]


def test_a_component_and_its_parameters_agree_on_the_period() -> None:
    documents = pdsl("period: {group: {compute: {type: int, default: 30}}}")
    documents["c.cdsl.yaml"] += "period: 20\n"
    (found,) = said(documents)
    assert found[:4] == ("RC3118", "30", "the component's 'period:' is 20 ms", "remove one of the two")


@pytest.mark.parametrize(
    ("flow", "types", "code", "at", "message", "hint"),
    [
        ('a: {type: itn}', '', 'RC3103', 'itn', "unknown type 'itn'", "did you mean 'int'?"),
        ('a: {type: integer}', '', 'RC3103', 'integer', "unknown type 'integer'", "did you mean 'int'?"),
        ('a: {type: Float64}', '', 'RC3103', 'Float64', "unknown type 'Float64'", "did you mean 'double'?"),
        ('a: {type: path}', '', 'RC3103', 'path', "unknown type 'path'", "did you mean 'string'?"),
        ('a: {type: Speeed}', 'Speed: {enum: [x]}', 'RC3103', 'Speeed', "unknown type 'Speeed'", "did you mean 'Speed'?"),
        ('a: {type: zzz}', 'Speed: {enum: [x]}', 'RC3103', 'zzz', "unknown type 'zzz'", 'there are: bool, int, long, float, double, string, Speed'),
        ('a: {default: 1}', '', 'RC3101', 'a', "parameter 'a' has no type", 'write one of type: …, list: …, map: …, group: …'),
        ('a: {type: int, list: int}', '', 'RC3102', 'list', "parameter 'a' cannot be 'type' and 'list' at once", ''),
        ('a: {list: {}}', '', 'RC3101', '{}', "the element type of 'a' has no type", 'write one of type: …, list: …, map: …'),
        ('a: {list: {type: int, map: int}}', '', 'RC3102', 'map', "the element type of 'a' cannot be 'type' and 'map' at once", ''),
        ('a: {map: {list: itn}}', '', 'RC3103', 'itn', "unknown type 'itn'", "did you mean 'int'?"),
        ('a: {type: A}', 'A: {list: A}', 'RC3104', 'A', "type 'A' contains itself: A → A", ''),
        ('a: {type: A}', 'A: {list: B}, B: {map: A}', 'RC3104', 'A', "type 'A' contains itself: A → B → A", ''),
        ('a: {type: A}', 'A: {struct: {b: B}}, B: {struct: {c: {list: A}}}', 'RC3104', 'A', "type 'A' contains itself: A → B → A", ''),
        ('a: {type: int}', 'Mode: {enum: [x, y]}', 'RC3107', 'Mode', "type 'Mode' is not used", ''),
        ('a: {type: int}', 'int: {enum: [x, y]}', 'RC3106', 'int', "'int' is the name of a basic type", ''),
        ('a: {type: E}', 'E: {enum: [x, y, x]}', 'RC3110', 'x', "enumerator 'x' appears twice", ''),
        ('a: {type: E}', 'E: {enum: [x, y, x], type: int}', 'RC3102', 'enum', "type 'E' cannot be 'type' and 'enum' at once", ''),
        ('a: {type: E}', 'E: {}', 'RC3101', 'E', "type 'E' has no type", 'write one of type: …, list: …, map: …, enum: …, struct: …'),
        ('a: {type: S}', 'S: {struct: {x: {default: 1}}}', 'RC3101', 'x', "member 'x' has no type", 'write one of type: …, list: …, map: …'),
        ('a: {type: int, default: 1, optional: true}', '', 'RC3112', 'default', "'a' has a default and is optional", ''),
        ('g: {group: {x: int}, optional: true}', '', 'RC3108', 'g', "'optional' does not apply to a group; set it for the members of the group", ''),
        ('g: {group: {x: int}, default: {x: 1}}', '', 'RC3108', 'default', "'default' does not apply to a group; set it for the members of the group", ''),
        ('a: {type: string, secret: true, default: x}', '', 'RC3125', 'default', "'a' is secret and cannot have a default", 'remove the default: set {env: NAME} or {file: PATH} in a values document'),
        ('a: {type: S, secret: true}', 'S: {struct: {x: int}}', 'RC3126', 'secret', "'a' cannot be secret as a whole: it is a mapping of x", ''),
        ('a: {list: S, secret: true}', 'S: {struct: {x: int}}', 'RC3126', 'secret', "'a' cannot be secret as a whole: it is a list of values that are not plain", ''),
        ('a: {group: {x: int}, secret: true}', '', 'RC3126', 'secret', "'a' cannot be secret as a whole: it is a group", ''),
        ('a: {map: string, secret: true}', '', 'RC3126', 'secret', "'a' cannot be secret as a whole: it is a mapping of names to values", ''),
        ('period: int', '', 'RC3118', 'period', "'period' must be the group of the worker's periods", 'write period: {group: {compute: …}}, or rename the parameter'),
        ('period: {group: {compute: float}}', '', 'RC3118', 'compute', "'period.compute' must be a whole number of milliseconds: int", ''),
        ('period: {group: {emergency: {type: string}}}', '', 'RC3118', 'emergency', "'period.emergency' must be a whole number of milliseconds: int", ''),
        ('period: {group: {compute: {list: int}}}', '', 'RC3118', 'compute', "'period.compute' must be a whole number of milliseconds: int", ''),
        ('a: {type: int, default: x}', '', 'RC3113', 'x', "the default of a must be a whole number, and is the text 'x'", ''),
        ('a: {type: int, range: [0, 5], default: 6}', '', 'RC3113', '6', 'the default of a is 6, and must be from 0 to 5', ''),
        ('a: {list: int, default: [1, x]}', '', 'RC3113', 'x', "the default of a[1] must be a whole number, and is the text 'x'", ''),
        ('a: {type: S, default: {x: 1}}', 'S: {struct: {x: int, y: int}}', 'RC3113', '{x: 1}', 'the default of a.y has no value, and no default', 'set it to a whole number'),
        ('a: {type: E, default: z}', 'E: {enum: [x, y]}', 'RC3113', 'z', "the default of a is 'z', and must be one of x, y", ''),
        ('a: {type: string, pattern: x, default: y}', '', 'RC3113', 'y', "the default of a is 'y', and must match x", ''),
        ('a: {map: int, default: {k: x}}', '', 'RC3113', 'x', "the default of a.k must be a whole number, and is the text 'x'", ''),
        ('a: {list: int, unique: true, default: [1, 1]}', '', 'RC3113', '1', 'the default of a contains 1 twice', ''),
        ('a-b: int', '', 'RC3114', 'a-b', "'a-b' cannot be a name in code", 'for instance as: a_b'),
        ('2d: int', '', 'RC3114', '2d', "'2d' cannot be a name in code", 'for instance as: p2d'),
        ('class: int, class_: int', '', 'RC3115', 'class_', "'class_' and 'class' are both named 'class_' in Python", 'set another name in code for one of them with as:'),
    ],
)  # fmt: skip
def test_wrong_parameters(flow: str, types: str, code: str, at: str, message: str, hint: str) -> None:
    assert [found[:4] for found in said(pdsl(flow, types), "c.pdsl.yaml")] == [(code, at, message, hint)]


def test_a_type_may_be_used_before_its_definition() -> None:
    types = "C: {struct: {a: A, b: {list: B}}}, B: {list: A}, A: {enum: [x, y]}"
    assert not said(pdsl("a: {list: {map: C}}, b: {list: A, default: [x]}", types), "c.pdsl.yaml")


def test_too_many_values_and_types_too_deep_are_rejected() -> None:
    wide = "P: {struct: {" + ", ".join(f"x{number}: int" for number in range(100)) + "}}"
    many = ", ".join(f"p{number}: {{type: P, optional: true}}" for number in range(50))
    assert not said(pdsl(many, wide), "c.pdsl.yaml")
    (found,) = said(pdsl(f"{many}, more: {{type: int, optional: true}}", wide), "c.pdsl.yaml")
    assert (found.code, found.message) == ("RC3105", "'parameters' has more than 5000 plain values")
    chain = ", ".join(f"T{number}: {{list: T{number + 1}}}" for number in range(40)) + ", T40: {list: int}"
    (deep,) = said(pdsl("a: {type: T0}", chain), "c.pdsl.yaml")
    assert (deep.code, deep.message) == ("RC3105", "'T30' has more than 30 nested types")
    chain = ", ".join(f"T{number}: {{list: T{number + 1}}}" for number in range(29)) + ", T29: {list: int}"
    assert not said(pdsl("a: {type: T0}", chain), "c.pdsl.yaml")


def test_a_fault_in_a_type_is_reported_once_and_hides_unused_types() -> None:
    found = said(pdsl("a: {type: T}, b: {type: T}", "T: {type: itn}, U: {enum: [x]}"), "c.pdsl.yaml")
    assert [one.code for one in found] == ["RC3103"]
