"""Documents of parameters with values that fit them, and values that may not."""

from __future__ import annotations

import math
from typing import Any

from hypothesis import strategies as st

from parameters import Data

NAMES = ("alpha", "beta", "gamma", "delta", "from", "size", "keys", "env", "file", "password", "2d", "a-b")
PATTERNS = {
    r"[A-Z][0-9]+": ("A1", "Z99"),
    r"/dev/\w+": ("/dev/x",),
    r"a|b": ("a", "b"),
    r".*": ("", "x#y"),
    r"[^,\s]{1,3}": ("é", "a=b"),
}
TEXTS = st.text(st.characters(exclude_categories=("Cs",), exclude_characters="\0\r\x85\u2028\u2029\ufeff"), max_size=6)
HARD_TEXTS = st.lists(
    st.sampled_from(
        ("#", "=", "\\", " ", "a", "é", ",", ";", '"', "'", "%", ".", "${env:X}", "${file:x}", ": ", "1", "true", "\t")
    ),
    max_size=5,
).map("".join)
KEYS = st.sampled_from(("left", "a.b", "a b", "", "keys", "size", "%", "x=y", "é", "0", "#", "\\", "[0]", "a\tb"))


@st.composite
def numbers(draw: st.DrawFn, name: str) -> tuple[Data, st.SearchStrategy[Any]]:
    """A number's type with its limits, and values within them."""
    whole = name in ("int", "long")
    within = st.integers(-1000, 1000) if whole else st.integers(-1000, 1000) | st.floats(-1e3, 1e3, width=32)
    match draw(st.sampled_from(("any", "range", "open", "values"))):
        case "range":
            low, high = sorted((draw(within) + 0, draw(within) + 0))  # -0.0 + 0 is 0.0
            inside = st.integers(low, high) if whole else st.floats(low, high)
            return {"type": name, "range": [low, high]}, inside
        case "open":
            low = draw(st.integers(-50, 50))
            high = low + draw(st.integers(2, 9))
            inside = (
                st.integers(low + 1, high - 1) if whole else st.floats(low, high, exclude_min=True, exclude_max=True)
            )
            return {"type": name, "range": {"above": low, "below": high}}, inside
        case "values":
            chosen = draw(st.lists(within, min_size=1, max_size=4, unique=True))
            return {"type": name, "values": chosen}, st.sampled_from(chosen)
    if not whole:
        widest = 3.4028234663852886e38 if name == "float" else 1.7976931348623157e308
        return {"type": name, "unit": "m"}, st.floats(-widest, widest) | st.integers(-9, 9)
    bits = 31 if name == "int" else 63
    return {"type": name, "unit": "m"}, st.integers(-(2**bits), 2**bits - 1) | st.sampled_from((0.0, 1.0, -3.0))


@st.composite
def texts(draw: st.DrawFn) -> tuple[Data, st.SearchStrategy[Any]]:
    match draw(st.sampled_from(("any", "pattern", "values"))):
        case "pattern":
            pattern = draw(st.sampled_from(sorted(PATTERNS)))
            return {"type": "string", "pattern": pattern}, st.sampled_from(PATTERNS[pattern])
        case "values":
            chosen = draw(st.lists(TEXTS | HARD_TEXTS, min_size=1, max_size=3, unique=True))
            return {"type": "string", "values": chosen}, st.sampled_from(chosen)
    return {"type": "string"}, TEXTS | HARD_TEXTS


ENUM = (({"type": "Mode"}), st.sampled_from(("slow", "fast", "off")))


@st.composite
def types(draw: st.DrawFn, depth: int = 2) -> tuple[Data, st.SearchStrategy[Any]]:
    """A type, and values that fit it."""
    kinds = ["bool", "number", "number", "string", "enum"] + ["list", "map", "struct"] * (depth > 0)
    match draw(st.sampled_from(kinds)):
        case "bool":
            return {"type": "bool"}, st.booleans()
        case "number":
            return draw(numbers(draw(st.sampled_from(("int", "long", "float", "double")))))
        case "string":
            return draw(texts())
        case "enum":
            return dict(ENUM[0]), ENUM[1]
        case "struct":
            return {"type": "Point"}, POINTS
        case "map":
            element, inner = draw(types(depth - 1))
            return {"map": element, "size": {"to": 3}}, st.dictionaries(KEYS, inner, max_size=3)
    element, inner = draw(types(depth - 1))
    least, plain = draw(st.integers(0, 2)), "list" not in element and "map" not in element
    if plain and element["type"] in ("string", "long") and "values" not in element and "pattern" not in element:
        if draw(st.booleans()):
            return {"list": element, "unique": True}, st.lists(inner, max_size=4, unique=True)
    return {"list": element, "size": [least, least + 3]}, st.lists(inner, min_size=least, max_size=least + 3)


POINT = {
    "x": {"type": "float", "range": [-10, 10]},
    "name": {"type": "string", "default": ""},
    "tag": {"type": "string", "optional": True},
    "on": {"type": "bool", "default": True},
    "note": {"type": "string", "default": "none"},
}
POINTS = st.fixed_dictionaries(
    {"x": st.integers(-10, 10) | st.floats(-10, 10)},
    optional={"name": TEXTS, "tag": TEXTS | HARD_TEXTS, "on": st.booleans(), "note": HARD_TEXTS},
)


def _named(name: str) -> Data:
    """The name in code, where it has to be another."""
    return {} if name.isidentifier() else {"as": f"p_{name.replace('-', '_')}"}


@st.composite
def members(draw: st.DrawFn, depth: int = 1) -> tuple[Data, st.SearchStrategy[Data]]:
    """Parameters, and values that fit them."""
    names = draw(st.lists(st.sampled_from(NAMES), min_size=1, max_size=4, unique=True))
    made: Data = {}
    needed: dict[str, Any] = {}
    free: dict[str, Any] = {}
    for name in names:
        if depth and draw(st.integers(0, 5)) == 0:
            group, inner = draw(members(depth - 1))
            made[name] = {"group": group, **_named(name)}
            needed[name] = inner
            continue
        type_, fitting = draw(types())
        match draw(st.sampled_from(("required", "default", "optional"))):
            case "required":
                needed[name] = fitting
            case "default":
                type_ = {**type_, "default": draw(fitting)}
                free[name] = fitting
            case _:
                type_ = {**type_, "optional": True}
                free[name] = fitting
        made[name] = {**type_, **_named(name)}
    return made, st.fixed_dictionaries(needed, optional=free)


@st.composite
def documents(draw: st.DrawFn) -> tuple[Data, Data]:
    """A document of parameters, and values that fit it."""
    made, fitting = draw(members())
    document = {
        "types": {"Mode": {"enum": ["slow", "fast", "off"]}, "Point": {"struct": POINT}},
        "parameters": made,
    }
    return document, draw(fitting)


JUNK = st.sampled_from(
    (
        True,
        False,
        0,
        1,
        1.0,
        1.5,
        -1e9,
        2**31,
        2**63,
        2**64,
        -(2**63) - 1,
        1e300,
        1e39,
        10**400,
        math.nan,
        math.inf,
        -math.inf,
        "",
        "1",
        "true",
        "slow",
        "A1\n",
        "xA1",
        "A1x",
        [],
        [1, 1.0],
        {},
        {"env": "HOME"},
        {"env": 1},
        {"env": "7UP"},
        {"env": "A\n"},
        {"env": "A", "b": 1},
        {"x": 1},
        {"file": "a/b c"},
        {"file": ""},
        {"file": "a/"},
        {"file": "a\nb"},
        {"file": 1},
        {"file": "a "},
        {"file": "}"},
        {"env": "A", "file": "b"},
        None,
        -0.0,
        "c",
        "é,x",
    )
)


@st.composite
def mutated(draw: st.DrawFn, data: Any) -> Any:
    """The same with one thing changed somewhere: a value replaced, a key added or taken away, an entry repeated."""
    if isinstance(data, dict) and data and draw(st.integers(0, 2)):
        key = draw(st.sampled_from(sorted(data)))
        match draw(st.sampled_from(("inside", "inside", "inside", "remove", "add"))):
            case "inside":
                return {**data, key: draw(mutated(data[key]))}
            case "remove":
                return {name: value for name, value in data.items() if name != key}
        return {**data, draw(st.sampled_from(("more", "x", "alpha"))): draw(JUNK)}
    if isinstance(data, list) and data and draw(st.integers(0, 2)):
        place = draw(st.integers(0, len(data) - 1))
        if draw(st.booleans()):
            return [*data[:place], draw(mutated(data[place])), *data[place + 1 :]]
        return [*data, *draw(st.sampled_from(([data[place]], [0, -0.0])))]  # the same zero, with another sign
    return draw(JUNK)
