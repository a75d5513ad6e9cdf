"""Infer the parameters of a component from all its configs."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

from robocomp_yaml.legacy.settings.entries import INT, TOML, Item, Leaf, Setting, Tree, guess
from robocomp_yaml.legacy.settings.families import families
from robocomp_yaml.legacy.settings.headers import free, sanitized
from robocomp_yaml.legacy.settings.plan import Config, Corrections, ParameterPlan, Path, PlannedValue
from robocomp_yaml.legacy.settings.rows import could_be_list, is_list, joiner, separators
from robocomp_yaml.legacy.settings.shapes import becomes_text, retyped, shape_of
from robocomp_yaml.semantics.rows import nested
from robocomp_yaml.semantics.spellings import Spelling

_PERIODS = {
    ("period",): "compute",
    ("Period", "Compute"): "compute",
    ("Period", "Emergency"): "emergency",
    ("period", "compute"): "compute",
    ("period", "emergency"): "emergency",
}
_MEMBER = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_-]*\Z")


def plans(configs: Sequence[Config], corrections: Corrections) -> list[ParameterPlan]:
    """Return the plans of the component's parameters. Settings that cannot be parameters remain properties of the
    configs."""
    candidates = list(families(configs, corrections))
    by_key: dict[Path, dict[str, Setting]] = {}
    for config in configs:
        for setting in config.parameters:
            by_key.setdefault(setting.path, {})[config.name] = setting
    for path, settings in by_key.items():
        candidates.append(_plan(path, settings, corrections))
    placed = list(_placed(candidates, configs))
    for plan in placed:
        plan.optional = len(plan.values) < len(configs)
        assert plan.shape is not None
        in_toml = [c.name for c in configs if c.sorted.dialect == TOML and c.name in plan.values]
        if not plan.guessed and any(becomes_text(plan.shape, plan.values[name].item.value) for name in in_toml):
            plan.guessed = "it is text in one config and a number in another, so that it becomes text"
        plan.shape = retyped(plan.shape, ".".join(plan.path), corrections.types)
    return placed


def _plan(path: Path, settings: dict[str, Setting], corrections: Corrections) -> ParameterPlan:
    """Return the plan of a key that is in no family: a plain value, or a list in one property."""
    plan = ParameterPlan(path)
    texts = {name: setting.text for name, setting in settings.items()}
    key = next(iter(settings.values())).key
    is_flat = all(isinstance(s.value, Leaf) and s.raw and not s.is_quoted for s in settings.values())
    are_lists = is_flat and any(map(is_list, texts.values())) and all(map(could_be_list, texts.values()))
    between = separators(texts.values())
    if are_lists and key not in corrections.text and not re.search(r"[{}]", key):
        plan.spelled = Spelling(
            key,
            separators=tuple(joiner(texts.values(), separator) for separator in between),
            trailing=any(text.endswith(between[0]) for text in texts.values()),
        )
        inner = f", and again at every '{between[1]}'" if between[1:] else ""
        plan.guessed = f"{key} is split into a list at every '{between[0]}'{inner}"
    for name, setting in settings.items():
        value = _listed(nested(setting.text, between, len(between), True)) if plan.spelled else setting.value
        plan.values[name] = PlannedValue(Item(value, setting.notes), [setting])
    return plan


def _listed(texts: Any) -> Tree:
    return guess(texts) if isinstance(texts, str) else [Item(_listed(part)) for part in texts]


def _placed(candidates: Sequence[ParameterPlan], configs: Sequence[Config]) -> Iterator[ParameterPlan]:
    """Yield the plans that have a type and a unique path. The settings of the others become properties of the
    configs."""
    used: set[Path] = set()
    groups = {tuple(map(_legal, plan.path[:depth])) for plan in candidates for depth in range(1, len(plan.path))}
    for plan in sorted(candidates, key=lambda plan: (plan.spelled is not None, len(plan.path))):
        original = plan.path
        plan.shape = shape_of([each.item.value for each in plan.values.values()])
        plan.built_in = _is_period(plan)
        if plan.built_in:
            plan.path = ("period", _PERIODS[original])
        elif original[0] == "period" or (plan.spelled is None and not all(original)):
            plan.shape = None
        else:
            plan.path = tuple(_legal(part) for part in original)
        if plan.shape is not None and plan.spelled is not None and plan.path in used | groups:
            plan.path = (*plan.path[:-1], free(f"{plan.path[-1]}_list", {path[-1] for path in used | groups}))
        if plan.shape is None or plan.path in used or (plan.path in groups and not plan.built_in):
            keep_as_properties(plan, configs)
            continue
        used.add(plan.path)
        if plan.path != original and plan.spelled is None:
            plan.spelled = Spelling(".".join(original))
    order = {config.name: number for number, config in enumerate(configs)}
    placed = [plan for plan in candidates if plan.shape is not None]
    yield from sorted(placed, key=lambda plan: min((order[name], each.line) for name, each in plan.values.items()))


def _is_period(plan: ParameterPlan) -> bool:
    """Whether a plan is a period that every component has."""
    if plan.path not in _PERIODS or plan.spelled is not None:
        return False
    leaves = [each.item.value for each in plan.values.values()]
    return all(isinstance(leaf, Leaf) and leaf.kind == INT and int(leaf.text) > 0 for leaf in leaves)


def _legal(part: str) -> str:
    if _MEMBER.match(part) and not part.startswith("x-"):
        return part
    return sanitized(part)


def keep_as_properties(plan: ParameterPlan, configs: Sequence[Config]) -> None:
    """Move the settings of a plan to the properties of their configs, and remove its type."""
    plan.shape = None
    for config in configs:
        each = plan.values.pop(config.name, None)
        if each is not None:
            for setting in each.settings:
                config.sorted.keep(setting)
