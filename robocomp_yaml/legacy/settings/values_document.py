"""Write the values document of one config: its settings by section, with their comments."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import msgspec

from robocomp_yaml.legacy.document import DocumentEntry, Map, Value
from robocomp_yaml.legacy.settings.entries import CLASSIC, FLAT_TOML, STRING, TOML, Leaf
from robocomp_yaml.legacy.settings.plan import Config, ParameterPlan, Path
from robocomp_yaml.legacy.settings.rows import squeezed
from robocomp_yaml.legacy.settings.shapes import ListShape, ScalarShape, plain, written
from robocomp_yaml.legacy.settings.sorting import NamedSetting
from robocomp_yaml.semantics.rows import joined, nested, split
from robocomp_yaml.semantics.texts import unquoted


class DocumentLinks(msgspec.Struct, frozen=True):
    """The paths in a values document: its component, its legacy file, and the document whose values it follows."""

    component: str
    file: str
    after: str = ""


def values_document(config: Config, plans: Sequence[ParameterPlan], links: DocumentLinks, *, exact: bool) -> Map:
    """Return the values document of a config. `exact` keeps the blanks around separators."""
    sorted_, dialect = config.sorted, config.sorted.dialect
    document = Map(block=True)
    document.put("component", links.component)
    document.put_some("parameters", _parameters(config, plans))
    document.put_some("endpoints", _section(sorted_.endpoints, _text))
    document.put_some("proxies", _section(sorted_.proxies, _proxy))
    topics = _section(sorted_.manager, _text)
    topics.put_some("prefix", _section(sorted_.prefixes, _text))
    topics.put_some("name", _section(sorted_.names, _text))
    document.put_some("topics", topics)
    document.put_some("ice", _section(sorted_.ice, _text if dialect == CLASSIC else _typed))
    document.put_some("properties", _section(sorted_.properties, lambda named: named.setting.raw or _verbatim(named)))
    document.put("legacy", _legacy(config, plans, links, exact))
    return document


def _section(entries: Sequence[NamedSetting], value: Callable[[NamedSetting], Value]) -> Map:
    return Map([DocumentEntry(named.name, value(named), named.setting.notes) for named in entries], block=True)


def _proxy(named: NamedSetting) -> Value:
    body = _text(named)
    return Map.of({"proxy": body, "key": named.key}) if named.key else body


def _text(named: NamedSetting) -> Value:
    return named.setting.text


def _typed(named: NamedSetting) -> Value:
    """Return a value as text if it has quotes, else with its type."""
    leaf = named.setting.value
    assert isinstance(leaf, Leaf)
    return plain(leaf, leaf.kind)


def _verbatim(named: NamedSetting) -> str:
    leaf = named.setting.value
    assert isinstance(leaf, Leaf)
    return f'"{leaf.text}"' if leaf.kind == STRING else leaf.text


def _parameters(config: Config, plans: Sequence[ParameterPlan]) -> Map:
    """Return the values of one config, nested by their paths, in the order of the file."""
    own = [plan for plan in plans if config.name in plan.values]
    top = Map(block=True)
    groups: dict[Path, Map] = {(): top}
    for plan in sorted(own, key=lambda plan: plan.values[config.name].line):
        for depth in range(1, len(plan.path)):
            path = plan.path[:depth]
            if path not in groups:
                groups[path] = Map(block=True)
                groups[path[:-1]].put(path[-1], groups[path])
        item = plan.values[config.name].item
        assert plan.shape is not None
        groups[plan.path[:-1]].put(plan.path[-1], written(plan.shape, item.value), item.notes)
    return top


def _legacy(config: Config, plans: Sequence[ParameterPlan], links: DocumentLinks, exact: bool) -> Map:
    body = Map()
    body.put("file", links.file)
    body.put_some("dialect", config.sorted.dialect if config.sorted.dialect != CLASSIC else "")
    body.put_some("after", links.after)
    originals = _originals(config, plans, exact) if config.sorted.dialect != TOML else ()
    body.put_some("exact", Map.of(dict(originals), block=True))
    return body


def _originals(config: Config, plans: Sequence[ParameterPlan], exact: bool) -> Iterator[tuple[str, str]]:
    """Yield the properties that an export would spell differently. Differences in blanks count only with `exact`."""
    for plan in plans:
        value = plan.values.get(config.name)
        spelled = plan.spelled
        if value is None:
            continue
        separators = spelled.separators or (spelled.separator,) if spelled else ()
        for setting in value.settings:
            respelled = setting.raw
            if spelled and spelled.columns:
                respelled = spelled.separator.join(split(setting.raw, ","))
            elif spelled and spelled.separators and not spelled.key.endswith("{i}"):
                parts = nested(setting.raw, spelled.separators, len(spelled.separators), True)
                respelled = joined(parts, spelled.separators, spelled.trailing)
            elif config.sorted.dialect == FLAT_TOML:
                respelled = _requoted(setting.raw, plan)
            is_same = squeezed(respelled, separators) == squeezed(setting.raw, separators)
            if respelled != setting.raw and (exact or not (is_same and separators)):
                yield setting.key, setting.raw
    if config.sorted.dialect == FLAT_TOML:
        sorted_ = config.sorted
        texts = [*sorted_.endpoints, *sorted_.proxies, *sorted_.manager, *sorted_.prefixes, *sorted_.names]
        for named in [*texts, *(named for named in sorted_.ice if isinstance(_typed(named), str))]:
            raw = named.setting.raw
            if '"' not in unquoted(raw) and raw != f'"{named.setting.text}"':
                yield named.setting.key, raw


def _requoted(raw: str, plan: ParameterPlan) -> str:
    """Return a plain value as flat TOML spells it: text in quotes."""
    shape = plan.shape.element if isinstance(plan.shape, ListShape) else plan.shape  # of rows that are texts
    kind = shape.kind if isinstance(shape, ScalarShape) else ""
    return f'"{unquoted(raw)}"' if kind == STRING and '"' not in unquoted(raw) else raw
