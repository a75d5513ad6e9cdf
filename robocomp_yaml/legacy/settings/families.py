"""Indexed families: `Motor0 = a,1`, `Motor1 = b,2` as a list of records, also where each field has its own keys."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence

import msgspec

from robocomp_yaml.legacy.document import Notes
from robocomp_yaml.legacy.settings.entries import Item, Leaf, Setting, Tree, guess
from robocomp_yaml.legacy.settings.headers import Column, columns, sanitized, unique
from robocomp_yaml.legacy.settings.plan import Config, Corrections, ParameterPlan, Path, PlannedValue
from robocomp_yaml.legacy.settings.rows import are_rows, joiner
from robocomp_yaml.legacy.settings.sorting import NamedSetting
from robocomp_yaml.semantics.rows import split
from robocomp_yaml.semantics.spellings import Spelling

_INDEXED = re.compile(r"(?P<stem>.*[^\d.])(?P<index>\d+)\Z")
_RANGE = re.compile(r"(?P<stem>[^\d].*?[^\w]|[A-Za-z_]+)(?P<from>\d+)-(?P<to>\d+)\Z")
_FREE = re.compile(r"[{}\s]")


class _Row(msgspec.Struct, frozen=True):
    config: Config
    setting: Setting
    index: str
    named: NamedSetting | None = None
    """The proxy that the setting is, too."""


_Numbers = tuple[tuple[str, tuple[int, ...]], ...]
Stems = dict[str, dict[str, list[_Row]]]


def families(configs: Sequence[Config], guesses: Corrections) -> Iterator[ParameterPlan]:
    """The plans of all families; their settings are taken out of the configs."""
    yield from _ranges(configs)
    stems = _stems(configs)
    for stem, by_config in stems.items():
        rows = [row for group in by_config.values() for row in group]
        if are_rows([row.setting.text for row in rows]):
            plan = _records(stem, by_config, configs, guesses)
            if plan is not None:
                yield plan
    yield from _parallel(configs)


def _stems(configs: Sequence[Config], pattern: re.Pattern[str] = _INDEXED, proxies: bool = False) -> Stems:
    """The settings whose keys differ in a last number only. Where one of them cannot be a row, none is: its key would
    be that of a row."""
    found: Stems = {}
    spoilt: set[str] = set()
    for config in configs:
        entries: list[tuple[Setting, NamedSetting | None]] = [(setting, None) for setting in config.parameters]
        if proxies:
            entries += [(named.setting, named) for named in config.sorted.proxies]
        for setting, named in entries:
            match = pattern.match(setting.key)
            if match is None or not setting.raw or _FREE.search(setting.key):
                continue
            if isinstance(setting.value, Leaf) and not setting.is_quoted:
                row = _Row(config, setting, match.groupdict().get("index", "0"), named)
                found.setdefault(match["stem"], {}).setdefault(config.name, []).append(row)
            else:
                spoilt.add(match["stem"])
    return {stem: by_config for stem, by_config in found.items() if stem not in spoilt}


def _numbering(groups: Sequence[list[_Row]]) -> int | None:
    """The first number, where each config counts up from it without a gap."""
    first = min((int(row.index) for row in groups[0]), default=0)
    for group in groups:
        numbers = sorted(int(row.index) for row in group)
        plain = all(row.index == str(int(row.index)) for row in group)
        if not plain or numbers != list(range(first, first + len(numbers))):
            return None
    return first if first <= 1_000_000 else None


def _records(
    stem: str, by_config: dict[str, list[_Row]], configs: Sequence[Config], guesses: Corrections
) -> ParameterPlan | None:
    """Rows of columns."""
    groups = list(by_config.values())
    first = _numbering(groups)
    if first is None and not _is_alone(stem, by_config, configs):
        return None
    titles = _titles(stem, groups, guesses)
    if titles is None:
        return None if first is None else _texts(stem, by_config, first)
    names, origin = titles
    plan = ParameterPlan(_path(stem), docs=tuple(names), guessed=_why(stem, origin, names, guesses))
    plan.is_unnamed = not origin
    texts = [row.setting.text for group in groups for row in group]
    keyed = first is None
    index = unique([*(column.name for column in names), "index"])[-1]
    plan.spelled = Spelling(
        f"{stem}{{{index}}}" if keyed else f"{stem}{{i}}",
        first=first or 0,
        columns=tuple(column.name for column in names),
        separator=joiner(texts, ","),
    )

    def record(row: _Row) -> dict[str, Item]:
        found = {index: Item(guess(row.index))} if keyed else {}
        return found | {c.name: Item(guess(cell)) for c, cell in zip(names, split(row.setting.text, ","), strict=False)}

    return _filled(plan, by_config, record)


def _titles(stem: str, groups: Sequence[list[_Row]], guesses: Corrections) -> tuple[list[Column], str] | None:
    """The columns of all rows. Configs of several versions of a component differ: where those of one are the first ones
    of the other, the rest is optional. None where nothing fits all."""
    found: dict[int, tuple[list[Column], str]] = {}
    for group in groups:
        top = min(group, key=lambda row: row.setting.span.line)
        arity = len(split(top.setting.text, ","))
        if any(len(split(row.setting.text, ",")) != arity for row in group):
            return None
        made = columns(stem, arity, top.config.source, top.setting.span.line, top.config.rules, guesses.names)
        if arity not in found or (made[1] and not found[arity][1]):
            found[arity] = made
    names, origin = found[max(found)]
    told = [column.name for column in names]
    if any([column.name for column in others] != told[: len(others)] for others, _ in found.values()):
        return None
    return names, origin


def _texts(stem: str, by_config: dict[str, list[_Row]], first: int) -> ParameterPlan:
    """Rows that differ in their columns, as a list of texts."""
    plan = ParameterPlan(_path(stem), spelled=Spelling(f"{stem}{{i}}", first=first), is_unnamed=True)
    plan.guessed = f"the rows {stem}… have different columns, so they are kept as texts"
    return _filled(plan, by_config, lambda row: Leaf(row.setting.text))


def _filled(plan: ParameterPlan, by_config: dict[str, list[_Row]], value: Callable[[_Row], Tree]) -> ParameterPlan:
    """The plan with a value for each row, in the order of their numbers."""
    for name, group in by_config.items():
        rows = sorted(group, key=lambda row: int(row.index))
        items = [Item(value(row), row.setting.notes) for row in rows]
        plan.given[name] = PlannedValue(Item(items), [row.setting for row in rows])
        for row in rows:
            _take(row)
    return plan


def _take(row: _Row) -> None:
    if row.named is not None:
        row.config.sorted.proxies.remove(row.named)
    else:
        row.config.parameters.remove(row.setting)


def _why(stem: str, origin: str, names: Sequence[Column], guesses: Corrections) -> str:
    """What was guessed; nothing where the user said it."""
    told = ", ".join(column.name for column in names)
    wrong = guesses.names.get(stem) or guesses.names.get(stem.rstrip("_.-"))
    if origin == "names":
        return ""
    if wrong:
        return f"{stem}… has {len(names)} columns, and --names gives {len(wrong)}; they are called {told}"
    where = {
        "header": f"the columns of {stem}… are taken from the comment above them: {told}",
        "known": f"the columns of {stem}… are called as such rows mostly are: {told}",
    }
    return where.get(origin, f"nothing says what the columns of {stem}… are; they are called {told}")


def _is_alone(stem: str, by_config: dict[str, list[_Row]], configs: Sequence[Config]) -> bool:
    """Whether no other parameter's key begins so: then the number may be part of the record."""
    own = {row.setting.key for group in by_config.values() for row in group}
    return not any(s.key.startswith(stem) and s.key not in own for config in configs for s in config.parameters)


def _path(stem: str) -> Path:
    parts = [part for part in stem.rstrip("_-.").split(".") if part]
    return tuple(parts) or ("rows",)


def _ranges(configs: Sequence[Config]) -> Iterator[ParameterPlan]:
    """Ranges in the key: `ID:0-10 = 100`."""
    for stem, by_config in _stems(configs, _RANGE).items():
        rows = [row for group in by_config.values() for row in group]
        if not _is_alone(stem, by_config, configs) or any("," in row.setting.text for row in rows):
            continue
        name = unique(["from", "to", _value_name(by_config)])[-1]
        plan = ParameterPlan(
            _path(re.sub(r"\W+\Z", "", stem)), guessed=f"what the ranges {stem}… are for is called {name}"
        )
        plan.spelled = Spelling(f"{stem}{{from}}-{{to}}", columns=(name,))

        def record(row: _Row, name: str = name) -> dict[str, Item]:
            match = _RANGE.match(row.setting.key)
            assert match is not None
            texts = {"from": match["from"], "to": match["to"], name: row.setting.text}
            return {key: Item(guess(text)) for key, text in texts.items()}

        yield _filled(plan, by_config, record)


def _value_name(by_config: dict[str, list[_Row]]) -> str:
    """The last word of the comment that all rows have behind them."""
    told = {" ".join(row.setting.notes.tail) for group in by_config.values() for row in group}
    words = told.pop().split() if len(told) == 1 else []
    return sanitized(words[-1]) if 0 < len(words) <= 3 and words[-1].isalpha() else "value"


def _parallel(configs: Sequence[Config]) -> Iterator[ParameterPlan]:
    """Several keys with the same numbers, one for each field: `rx_0`, `ry_0`, `rx_1`, `ry_1`."""
    alike: dict[tuple[str, _Numbers], list[str]] = {}
    stems = _stems(configs, proxies=True)
    for stem, by_config in stems.items():
        if _numbering(list(by_config.values())) is not None:
            numbers = tuple((name, tuple(sorted(int(r.index) for r in rows))) for name, rows in by_config.items())
            alike.setdefault((stem.rpartition(".")[0], numbers), []).append(stem)
    for (group, numbers), names in alike.items():
        rows = max(len(indices) for _, indices in numbers)
        if len(names) < 2 or all(row.named for name in names for each in stems[name].values() for row in each):
            continue
        count = _count(group, names, configs, rows)
        if rows < 2 and not count:
            continue
        yield _fields(group, names, stems, count, configs)


def _fields(group: str, names: list[str], stems: Stems, count: str, configs: Sequence[Config]) -> ParameterPlan:
    bare = [name.rpartition(".")[2] if group else name for name in names]
    fields = unique([sanitized(name) for name in bare])
    title = count or "_".join(field.strip("_") for field in fields[:3])
    path = (*(group.split(".") if group else ()), title)
    told = ", ".join(fields)
    plan = ParameterPlan(
        path, guessed=f"{', '.join(names)} count alike, so they are fields of one list, {title}: {told}"
    )
    groups = list(stems[names[0]].values())
    plan.spelled = Spelling(
        fields=tuple((field, f"{name}{{i}}") for field, name in zip(fields, names, strict=True)),
        first=_numbering(groups) or 0,
    )
    for config in configs:
        if config.name not in stems[names[0]]:
            continue
        given, records = PlannedValue(Item([])), dict[int, dict[str, Item]]()
        for field, name in zip(fields, names, strict=True):
            for row in stems[name][config.name]:
                records.setdefault(int(row.index), {})[field] = Item(guess(row.setting.text), row.setting.notes)
                given.settings.append(row.setting)
                _take(row)
        given.item.value = [Item(records[number], _above(records[number])) for number in sorted(records)]
        plan.given[config.name] = given
    return plan


def _above(record: dict[str, Item]) -> Notes:
    """The comments above a record's first field stand above the record."""
    first = next(iter(record.values()))
    notes = Notes(head=first.notes.head)
    first.notes = Notes(tail=first.notes.tail, foot=first.notes.foot)
    return notes


def _count(group: str, names: Sequence[str], configs: Sequence[Config], rows: int) -> str:
    """What a count beside the family counts: `cameras` for `num_cameras`."""
    for config in configs:
        for setting in config.parameters:
            parent, _, name = setting.key.rpartition(".")
            pattern = config.rules.counts
            if parent == group and pattern and pattern.search(name) and setting.text == str(rows):
                what = pattern.sub("", name).strip("_")
                if what and what not in names:
                    return sanitized(what)
    return ""
