"""How code uses the worker, as facts that are the same for every language.

A language's part `usage` reads them. It is silent about all that it cannot be sure of.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.diag.span import Span

if TYPE_CHECKING:
    from robocomp_yaml.emit.usage.offer import OfferedMember

WORKER, MODULES, SETTINGS, SERVED, FILE = "worker", "modules", "settings", "served", "file"
"""Where a chain begins: at the worker, at the Slice modules, at the properties that RoboComp's code gets, at the
arguments of the worker's own methods, or at what the file itself defines."""


class Word(msgspec.Struct, frozen=True):
    text: str
    span: Span


NUMBER, TEXT, TRUTH, LIST, TUPLE, SET = "a number", "a text", "true or false", "a list", "a tuple", "a set"
CONDITION, LOOPED = "a condition", "a list"
MAPPING, NOTHING, NO_MAPPING, FUNCTION, GENERATOR = "a mapping", "None", "no mapping", "a function", "a generator"
"""What a value surely is, in words."""


class Constant(msgspec.Struct, frozen=True):
    """A value that is written literally."""

    value: object
    span: Span


class Arguments(msgspec.Struct, frozen=True):
    """The arguments of a call: `count` by position and `names` by keyword; `is_exact` unless some are unpacked. `text`
    is the first one if it is a literal text, `keys` are those of the first one if it is a literal mapping. `constant`
    is the last one by position if it is a literal; `values` are all by position, None for those that are not, and
    `named` those by keyword. `forms` says what those by position surely are, such as MAPPING or "a list", `chains` are
    those that are chains; None if unknown. `inside` are the literals in each that is a literal list or tuple, and
    `under` those of the `keys`."""

    count: int = 0
    names: tuple[Word, ...] = ()
    is_exact: bool = True
    text: Word | None = None
    keys: tuple[Word, ...] = ()
    constant: Constant | None = None
    values: tuple[Constant | None, ...] = ()
    named: tuple[Constant | None, ...] = ()
    forms: tuple[Word | None, ...] = ()
    chains: tuple[Chain | None, ...] = ()
    inside: tuple[tuple[Constant, ...], ...] = ()
    under: tuple[Constant | None, ...] = ()


class Step(msgspec.Struct, frozen=True):
    """One step of a chain: a name, called if it has `arguments`; or an index, whose name is '' unless it is a literal
    text; or an element in a loop (`is_each`). `shown` is an index as it is written, and `place` its value if that is a
    literal number. `is_instance`: the name is a type, and the step leads to a value of it. `makes` is "list" or "map"
    if the step leads from a value to many of them."""

    word: Word
    arguments: Arguments | None = None
    is_index: bool = False
    is_each: bool = False
    shown: Word | None = None
    place: int | None = None
    is_instance: bool = False
    makes: str = ""


class Chain(msgspec.Struct, frozen=True):
    """Names that lead from one value to the next: `self.mouth_proxy.move(pose)`. If a value is assigned to its end,
    `is_assigned`, and `constant` is the value if it is a literal. `caught` are the exceptions that the code around it
    handles by name. `compared` are the literals that it is compared with, and `unpacked` is the number of variables to
    which it is unpacked. `is_again`: another chain has all of its steps, and is judged. `is_hint`: it is part of an
    annotation that is not evaluated. `added` is what it is added to, and `used` what it is used as."""

    root: str
    steps: tuple[Step, ...]
    is_assigned: bool = False
    constant: Constant | None = None
    caught: frozenset[str] = frozenset()
    compared: tuple[Constant, ...] = ()
    unpacked: int = 0
    is_again: bool = False
    is_hint: bool = False
    added: Word | None = None
    used: str = ""


WITHOUT_SELF, NO_SELF, NOT_CALLED, NOT_GENERATED = "without self", "no self", "not called", "not generated"
UNDEFINED, REPEATED, NO_INIT, NO_RESULT, NO_METHOD = "undefined", "repeated", "no init", "no result", "no method"
ARROW = "arrow"

ASYNC, YIELDS, PROPERTY = "async", "a generator", "a property"
STATIC, VALUE = "a static method with self", "a value"
"""What is there instead of a method that the generated code calls."""


class Slip(msgspec.Struct, frozen=True):
    """A slip of another kind. `meant` is what should be there, or is one of `known`."""

    kind: str
    word: Word
    meant: str = ""
    known: tuple[str, ...] = ()


class Returned(msgspec.Struct, frozen=True):
    """A value that a method of the worker returns; `values` are its elements if `is_tuple`, else the value alone."""

    method: str
    span: Span
    values: Arguments
    is_tuple: bool = False


class CodeUsage(msgspec.Struct, frozen=True):
    """The use that the files of a component make of the worker.

    `methods` are those of the classes that are derived from the generic worker. `own` are names that the code defines
    itself, `texts` its literal texts: names in them may be used in ways that nobody sees. `is_open`: the worker may
    have further attributes, which are set without their names; `is_shared`: other code may set some. `faults` are
    errors of syntax, each with a text; with any, nothing else is read. `signatures` are those of methods that the code
    defines itself, and `functions` those of its functions, by file.
    """

    chains: tuple[Chain, ...] = ()
    methods: tuple[Word, ...] = ()
    own: frozenset[str] = frozenset()
    texts: frozenset[str] = frozenset()
    is_open: bool = False
    is_shared: bool = False
    faults: tuple[tuple[str, Span], ...] = ()
    slips: tuple[Slip, ...] = ()
    returned: tuple[Returned, ...] = ()
    signatures: Mapping[str, OfferedMember] = {}
    functions: Mapping[str, Mapping[str, OfferedMember]] = {}


def literal_head(steps: tuple[Step, ...]) -> tuple[Step, ...]:
    """The leading indices that are literal texts; () if another index follows them, or none leads."""
    head: list[Step] = []
    for step in steps:
        if not step.is_index:
            break
        if not step.word.text:
            return ()
        head.append(step)
    return tuple(head)
