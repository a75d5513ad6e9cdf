"""Compares the user's class with a new skeleton: missing, outdated and obsolete methods."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence

import msgspec

from robocomp_yaml.diag.suggest import suggest
from robocomp_yaml.emit.specific.code import Signature, SourceCode, SourceMethod
from robocomp_yaml.emit.specific.types import Differ
from robocomp_yaml.grouping import grouped


class MissingMethod(msgspec.Struct, frozen=True):
    """A method of a skeleton that the user's files lack."""

    skeleton: SourceCode
    method: SourceMethod


class OutdatedMethod(msgspec.Struct, frozen=True):
    """A method of the user that does not match its interface any more; `expected` is that of the skeleton."""

    code: SourceCode
    method: SourceMethod
    skeleton: SourceCode
    expected: SourceMethod


class ObsoleteMethod(msgspec.Struct, frozen=True):
    """A method that no skeleton has any more, with its occurrences; `renamed` is its probable new name."""

    name: str
    occurrences: tuple[tuple[SourceCode, SourceMethod], ...]
    renamed: str = ""


class Comparison(msgspec.Struct):
    missing: list[MissingMethod] = []
    outdated: list[OutdatedMethod] = []
    obsolete: list[ObsoleteMethod] = []


Accepted = Mapping[str, tuple[SourceMethod, ...]]
"""Signatures that are right besides those of the skeleton, by the method's name. Such a method may be missing."""

_NOTHING: Accepted = {}
_HEAD = re.compile(r"(\w+)\s*\(")


def accepted_in(codes: Iterable[SourceCode]) -> Accepted:
    """The methods that the classes declare, by name."""
    by_name: dict[str, tuple[SourceMethod, ...]] = {}
    for code in codes:
        for method in code.members:
            by_name[method.name] = (*by_name.get(method.name, ()), method)
    return by_name


def compare(
    new: Sequence[SourceCode], base: Mapping[str, SourceCode], yours: Sequence[SourceCode], bases: Collection[str] = (),
    accepted: Accepted = _NOTHING, differ: Differ = lambda mine, expected, is_result: False,
    hidden: Collection[str] = (),
) -> Comparison:  # fmt: skip
    """Compares the user's files, `yours`, with the new skeleton. `base` are the skeletons that the user's files were
    written from, as far as they are known, by path. `bases` are the base classes of the skeleton's class, in addition
    to those in `new`. `accepted` are further signatures. `differ` compares types. `hidden` are
    methods that are not missing, although the grammar does not see them."""
    result = Comparison()
    members, definitions = _by_name(yours, "members"), _by_name(yours, "definitions")
    bodies = {name: [pair for pair in pairs if pair[1].has_body] for name, pairs in members.items()}
    elsewhere = _inherited(new, yours, bases)
    for skeleton in new:
        older = base.get(skeleton.path)
        for part, known in (("members", members), ("definitions", definitions)):
            before = {method.name: method for method in getattr(older, part, ())}
            for method in getattr(skeleton, part):
                mine = known.get(method.name, [])
                others = accepted.get(method.name, ())
                inside = bodies if part == "definitions" else {}
                defined = bool(mine or inside.get(method.name)) or method.name in hidden
                if accepted and not defined:
                    # The oldest versions of RoboComp's tool omit the interface's name, which another one may have, too.
                    old = method.name.partition("_")[2]
                    pairs = (*known.get(old, ()), *inside.get(old, ()))
                    defined = old in hidden or any(_fits(one, method, None, differ) for _, one in pairs)
                if not defined and method.name not in elsewhere and not others:
                    result.missing.append(MissingMethod(skeleton, method))
                if mine and not any(_fits_any(one, method, before.get(method.name), others, differ) for _, one in mine):
                    result.outdated.append(OutdatedMethod(*mine[0], skeleton, method))
    result.obsolete = list(_obsolete(new, base, members, definitions, result.missing))
    return result


def behind_errors(yours: Iterable[SourceCode]) -> set[str]:
    """The methods that may be behind a syntax error, where the grammar sees none: those that look like it."""
    names: set[str] = set()
    for code in yours:
        if code.faults:
            heads = {name for line in code.lines for name in _HEAD.findall(line)}
            names |= heads - {method.name for method in code.methods}
    return names


def _by_name(codes: Iterable[SourceCode], part: str) -> dict[str, list[tuple[SourceCode, SourceMethod]]]:
    return grouped((method.name, (code, method)) for code in codes for method in getattr(code, part))


def _inherited(new: Sequence[SourceCode], yours: Sequence[SourceCode], bases: Collection[str]) -> set[str]:
    """The methods that the class may inherit from a class of the user: those whose names occur anywhere."""
    expected = {*bases, *(base for code in new for base in code.bases)}
    if all(base in expected for code in yours for base in code.bases):
        return set()
    words = {word for code in yours for line in code.lines for word in re.findall(r"\w+", line)}
    return {method.name for code in new for method in code.methods} & words


def _fits_any(
    mine: SourceMethod, expected: SourceMethod, before: SourceMethod | None, others: Iterable[SourceMethod],
    differ: Differ,
) -> bool:  # fmt: skip
    return _fits(mine, expected, before, differ) or any(_fits(mine, other, None, differ) for other in others)


def _fits(mine: SourceMethod, expected: SourceMethod, before: SourceMethod | None, differ: Differ) -> bool:
    """Whether a method matches that of the new skeleton. Parameters that the user changed since the skeleton `before`
    are accepted, unless their number or a type surely does not match."""
    is_, needs = mine.signature, expected.signature
    if is_ is not None and needs is not None and is_.names != needs.names and sorted(is_.names) == sorted(needs.names):
        return False  # the parameters changed places: calls pass them by position
    if is_ is None or needs is None or _types(is_) == _types(needs):
        return True
    count = len(needs.parameters)
    if is_.least > count or (is_.most is not None and is_.most < count):
        return False
    pairs = zip(is_.parameters, needs.parameters, strict=False)
    if any(differ(*pair, False) for pair in pairs) or differ(is_.returns, needs.returns, True):
        return False
    was = before.signature if before else None
    if was is None:
        return True
    triples = [*zip(is_.parameters, was.parameters, needs.parameters, strict=False)]
    triples.append((is_.returns, was.returns, needs.returns))
    names = {now.partition(" ")[0] for now in needs.parameters}
    return not any(mine == old and _differ(old, now, names) for mine, old, now in triples)


def _differ(old: str, now: str, names: Collection[str]) -> bool:
    """Whether a parameter or result changed. An added or removed type is no change, nor is another name for the same
    parameter: calls pass it by its position. `names` are those of all parameters now: one of them has moved."""
    if not old or not now or (" : " in old) != (" : " in now):
        return old.partition(" ")[0] != now.partition(" ")[0] and bool(old and now)
    (name, _, type_), (new_name, _, new_type) = old.partition(" : "), now.partition(" : ")
    return type_ != new_type or (name != new_name and (not type_ or name in names))


def _types(signature: Signature) -> tuple[object, ...]:
    return signature.parameters, signature.returns


def _obsolete(
    new: Sequence[SourceCode],
    base: Mapping[str, SourceCode],
    members: Mapping[str, list[tuple[SourceCode, SourceMethod]]],
    definitions: Mapping[str, list[tuple[SourceCode, SourceMethod]]],
    lacking: Sequence[MissingMethod],
) -> Iterable[ObsoleteMethod]:
    today = {method.name for code in new for method in code.methods}
    before = {m.name: m for code in base.values() for m in (*code.definitions, *code.members)}
    fresh = {one.method.name: one.method for one in lacking if one.method.name not in before}
    for name, method in before.items():
        occurrences = (*members.get(name, ()), *definitions.get(name, ()))
        if name in today or not occurrences:
            continue
        alike = [other for other, its in fresh.items() if _same(method.signature, its.signature)]
        alike = [other for other in alike if other.partition("_")[0] == name.partition("_")[0]]
        yield ObsoleteMethod(name, occurrences, alike[0] if len(alike) == 1 else suggest(name, alike) or "")


def _same(one: Signature | None, other: Signature | None) -> bool:
    return bool(one and other and (one.parameters, one.returns) == (other.parameters, other.returns))
