"""Families of numbered keys as lists of records: `Motor0 = a,1`, `Motor1 = b,2`; also with a key for each field."""

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
_BRACE_OR_BLANK = re.compile(r"[{}\s]")


class _Row(msgspec.Struct, frozen=True):
    config: Config
    setting: Setting
    index: str
    named: NamedSetting | None = None
    """The entry under `proxies:` that the setting also is."""


_Numbers = tuple[tuple[str, tuple[int, ...]], ...]
Stems = dict[str, dict[str, list[_Row]]]


def families(configs: Sequence[Config], corrections: Corrections) -> Iterator[ParameterPlan]:
    """Yield the plans of all families, and remove their settings from the configs."""
    yield from _ranges(configs)
    stems = _stems(configs)
    for stem, by_config in stems.items():
        rows = [row for group in by_config.values() for row in group]
        if are_rows([row.setting.text for row in rows]):
            plan = _records(stem, by_config, configs, corrections)
            if plan is not None:
                yield plan
    yield from _parallel(configs)


def _stems(configs: Sequence[Config], pattern: re.Pattern[str] = _INDEXED, proxies: bool = False) -> Stems:
    """Group the settings whose keys differ only in a number, by stem and config. A stem with a setting that cannot be a
    row is excluded, because a row would get that setting's key."""
    found: Stems = {}
    excluded: set[str] = set()
    for config in configs:
        entries: list[tuple[Setting, NamedSetting | None]] = [(setting, None) for setting in config.parameters]
        if proxies:
            entries += [(named.setting, named) for named in config.sorted.proxies]
        for setting, named in entries:
            match = pattern.match(setting.key)
            if match is None or not setting.raw or _BRACE_OR_BLANK.search(setting.key):
                continue
            if isinstance(setting.value, Leaf) and not setting.is_quoted:
                row = _Row(config, setting, match.groupdict().get("index", "0"), named)
                found.setdefault(match["stem"], {}).setdefault(config.name, []).append(row)
            else:
                excluded.add(match["stem"])
    return {stem: by_config for stem, by_config in found.items() if stem not in excluded}


def _numbering(groups: Sequence[list[_Row]]) -> int | None:
    """Return the first number, if the numbers of each config start with it and have no gap; else None."""
    first = min((int(row.index) for row in groups[0]), default=0)
    for group in groups:
        numbers = sorted(int(row.index) for row in group)
        plain = all(row.index == str(int(row.index)) for row in group)
        if not plain or numbers != list(range(first, first + len(numbers))):
            return None
    return first if first <= 1_000_000 else None


def _records(
    stem: str, by_config: dict[str, list[_Row]], configs: Sequence[Config], corrections: Corrections
) -> ParameterPlan | None:
    """Return the plan of rows with columns; None if they are no list."""
    groups = list(by_config.values())
    first = _numbering(groups)
    if first is None and not _is_alone(stem, by_config, configs):
        return None
    header = _common_columns(stem, groups, corrections)
    if header is None:
        return None if first is None else _texts(stem, by_config, first)
    names, origin = header
    plan = ParameterPlan(_path(stem), docs=tuple(names), guessed=_guess_message(stem, origin, names, corrections))
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


def _common_columns(
    stem: str, groups: Sequence[list[_Row]], corrections: Corrections
) -> tuple[list[Column], str] | None:
    """Return the columns of all rows, and the source of their names; None where no columns fit all rows. Configs of
    several versions of a component may differ: if one has the first columns of the other, the rest is optional."""
    found: dict[int, tuple[list[Column], str]] = {}
    for group in groups:
        top = min(group, key=lambda row: row.setting.span.line)
        arity = len(split(top.setting.text, ","))
        if any(len(split(row.setting.text, ",")) != arity for row in group):
            return None
        made = columns(stem, arity, top.config.source, top.setting.span.line, top.config.rules, corrections.names)
        if arity not in found or (made[1] and not found[arity][1]):
            found[arity] = made
    names, origin = found[max(found)]
    listed = [column.name for column in names]
    if any([column.name for column in others] != listed[: len(others)] for others, _ in found.values()):
        return None
    return names, origin


def _texts(stem: str, by_config: dict[str, list[_Row]], first: int) -> ParameterPlan:
    """Return the plan of rows with different columns: a list of texts."""
    plan = ParameterPlan(_path(stem), spelled=Spelling(f"{stem}{{i}}", first=first), is_unnamed=True)
    plan.guessed = f"the rows {stem}… have different columns, so that they are kept as texts"
    return _filled(plan, by_config, lambda row: Leaf(row.setting.text))


def _filled(plan: ParameterPlan, by_config: dict[str, list[_Row]], value: Callable[[_Row], Tree]) -> ParameterPlan:
    """Return the plan with a value for each row, in the order of the rows' numbers."""
    for name, group in by_config.items():
        rows = sorted(group, key=lambda row: int(row.index))
        items = [Item(value(row), row.setting.notes) for row in rows]
        plan.values[name] = PlannedValue(Item(items), [row.setting for row in rows])
        for row in rows:
            _remove(row)
    return plan


def _remove(row: _Row) -> None:
    if row.named is not None:
        row.config.sorted.proxies.remove(row.named)
    else:
        row.config.parameters.remove(row.setting)


def _guess_message(stem: str, origin: str, names: Sequence[Column], corrections: Corrections) -> str:
    """Return what was guessed; '' where the user named the columns."""
    listed = ", ".join(column.name for column in names)
    requested = corrections.names.get(stem) or corrections.names.get(stem.rstrip("_.-"))
    if origin == "names":
        return ""
    if requested:
        return f"{stem}… has {len(names)} columns, but --names has {len(requested)}; the columns are named {listed}"
    sources = {
        "header": f"the comment above {stem}… names the columns {listed}",
        "known": f"the columns of {stem}… have the usual names of such rows: {listed}",
    }
    return sources.get(origin, f"the columns of {stem}… have no known names; they are named {listed}")


def _is_alone(stem: str, by_config: dict[str, list[_Row]], configs: Sequence[Config]) -> bool:
    """Whether no other parameter's key starts with the stem. Then the number may be part of the record."""
    own = {row.setting.key for group in by_config.values() for row in group}
    return not any(s.key.startswith(stem) and s.key not in own for config in configs for s in config.parameters)


def _path(stem: str) -> Path:
    parts = [part for part in stem.rstrip("_-.").split(".") if part]
    return tuple(parts) or ("rows",)


def _ranges(configs: Sequence[Config]) -> Iterator[ParameterPlan]:
    """Yield the plans of keys with ranges: `ID:0-10 = 100`."""
    for stem, by_config in _stems(configs, _RANGE).items():
        rows = [row for group in by_config.values() for row in group]
        if not _is_alone(stem, by_config, configs) or any("," in row.setting.text for row in rows):
            continue
        name = unique(["from", "to", _value_name(by_config)])[-1]
        what = f"the value of the ranges {stem}… is named {name}"
        plan = ParameterPlan(_path(re.sub(r"\W+\Z", "", stem)), guessed=what)
        plan.spelled = Spelling(f"{stem}{{from}}-{{to}}", columns=(name,))

        def record(row: _Row, name: str = name) -> dict[str, Item]:
            match = _RANGE.match(row.setting.key)
            assert match is not None
            texts = {"from": match["from"], "to": match["to"], name: row.setting.text}
            return {key: Item(guess(text)) for key, text in texts.items()}

        yield _filled(plan, by_config, record)


def _value_name(by_config: dict[str, list[_Row]]) -> str:
    """Return the last word of the comment that all rows have at their end, or `value`."""
    comments = {" ".join(row.setting.notes.tail) for group in by_config.values() for row in group}
    words = comments.pop().split() if len(comments) == 1 else []
    return sanitized(words[-1]) if 0 < len(words) <= 3 and words[-1].isalpha() else "value"


def _parallel(configs: Sequence[Config]) -> Iterator[ParameterPlan]:
    """Yield the plans of keys with the same numbers, one for each field: `rx_0`, `ry_0`, `rx_1`, `ry_1`."""
    by_numbers: dict[tuple[str, _Numbers], list[str]] = {}
    stems = _stems(configs, proxies=True)
    for stem, by_config in stems.items():
        if _numbering(list(by_config.values())) is not None:
            numbers = tuple((name, tuple(sorted(int(r.index) for r in rows))) for name, rows in by_config.items())
            by_numbers.setdefault((stem.rpartition(".")[0], numbers), []).append(stem)
    for (group, numbers), names in by_numbers.items():
        rows = max(len(indices) for _, indices in numbers)
        if len(names) < 2 or all(row.named for name in names for each in stems[name].values() for row in each):
            continue
        count = _count(group, names, configs, rows)
        if rows < 2 and not count:
            continue
        yield _fields(group, names, stems, count, configs)


def _fields(group: str, names: list[str], stems: Stems, count: str, configs: Sequence[Config]) -> ParameterPlan:
    short_names = [name.rpartition(".")[2] if group else name for name in names]
    fields = unique([sanitized(name) for name in short_names])
    title = count or "_".join(field.strip("_") for field in fields[:3])
    path = (*(group.split(".") if group else ()), title)
    what = f"have the same numbers, so that they become fields of one list, {title}: {', '.join(fields)}"
    plan = ParameterPlan(path, guessed=f"{', '.join(names)} {what}")
    groups = list(stems[names[0]].values())
    plan.spelled = Spelling(
        fields=tuple((field, f"{name}{{i}}") for field, name in zip(fields, names, strict=True)),
        first=_numbering(groups) or 0,
    )
    for config in configs:
        if config.name not in stems[names[0]]:
            continue
        planned, records = PlannedValue(Item([])), dict[int, dict[str, Item]]()
        for field, name in zip(fields, names, strict=True):
            for row in stems[name][config.name]:
                records.setdefault(int(row.index), {})[field] = Item(guess(row.setting.text), row.setting.notes)
                planned.settings.append(row.setting)
                _remove(row)
        planned.item.value = [Item(records[number], _record_comments(records[number])) for number in sorted(records)]
        plan.values[config.name] = planned
    return plan


def _record_comments(record: dict[str, Item]) -> Notes:
    """Move the comments above a record's first field, and return them as those of the record."""
    first = next(iter(record.values()))
    notes = Notes(head=first.notes.head)
    first.notes = Notes(tail=first.notes.tail, foot=first.notes.foot)
    return notes


def _count(group: str, names: Sequence[str], configs: Sequence[Config], rows: int) -> str:
    """Return what a count in the same group counts: `cameras` for `num_cameras`; '' without such a count."""
    for config in configs:
        for setting in config.parameters:
            parent, _, name = setting.key.rpartition(".")
            pattern = config.rules.counts
            if parent == group and pattern and pattern.search(name) and setting.text == str(rows):
                what = pattern.sub("", name).strip("_")
                if what and what not in names:
                    return sanitized(what)
    return ""
