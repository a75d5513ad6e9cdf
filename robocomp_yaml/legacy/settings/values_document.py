"""The values document of one config: its settings by section, with their comments where they stood."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import msgspec

from robocomp_yaml.legacy.document import Entry, Map, Value
from robocomp_yaml.legacy.settings import rows
from robocomp_yaml.legacy.settings.entries import CLASSIC, FLAT_TOML, STRING, TOML, Leaf
from robocomp_yaml.legacy.settings.plan import Config, Path, Plan
from robocomp_yaml.legacy.settings.shapes import plain, written
from robocomp_yaml.legacy.settings.sorting import Named
from robocomp_yaml.semantics.texts import unquoted


class Links(msgspec.Struct, frozen=True):
    """What a values document says of itself: its component, the file it was, and the document it comes after."""

    component: str
    file: str
    after: str = ""


def values_document(config: Config, plans: Sequence[Plan], links: Links, *, exact: bool) -> Map:
    found, dialect = config.sorted, config.sorted.dialect
    document = Map(block=True)
    document.put("component", links.component)
    parameters = _parameters(config, plans)
    if parameters.entries:
        document.put("parameters", parameters)
    _put_section(document, "endpoints", found.endpoints, dialect)
    proxies = Map(block=True)
    for named in found.proxies:
        body: Value = _text(named)
        if named.key:
            body = Map([Entry("proxy", body), Entry("key", named.key)])
        proxies.put(named.name, body, named.setting.notes)
    if proxies.entries:
        document.put("proxies", proxies)
    topics = Map(block=True)
    for named in found.manager:
        topics.put("manager", _text(named), named.setting.notes)
    _put_section(topics, "prefix", found.prefixes, dialect)
    _put_section(topics, "name", found.names, dialect)
    if topics.entries:
        document.put("topics", topics)
    ice = Map(block=True)
    for named in found.ice:
        ice.put(named.name, _text(named) if dialect == CLASSIC else _typed(named), named.setting.notes)
    if ice.entries:
        document.put("ice", ice)
    properties = Map(block=True)
    for named in found.properties:
        properties.put(named.name, named.setting.raw or _verbatim(named), named.setting.notes)
    if properties.entries:
        document.put("properties", properties)
    document.put("legacy", _legacy(config, plans, links, exact))
    return document


def _put_section(document: Map, title: str, entries: Sequence[Named], dialect: str) -> None:
    section = Map(block=True)
    for named in entries:
        section.put(named.name, _text(named), named.setting.notes)
    if section.entries:
        document.put(title, section)


def _text(named: Named) -> Value:
    return named.setting.text


def _typed(named: Named) -> Value:
    """A value as text where it stands in quotes, else as it is."""
    leaf = named.setting.value
    assert isinstance(leaf, Leaf)
    return plain(leaf, leaf.kind)


def _verbatim(named: Named) -> str:
    leaf = named.setting.value
    assert isinstance(leaf, Leaf)
    return f'"{leaf.text}"' if leaf.kind == STRING else leaf.text


def _parameters(config: Config, plans: Sequence[Plan]) -> Map:
    """The values of one config, nested by their paths, in the order of the file."""
    own = [plan for plan in plans if config.name in plan.given]
    top = Map(block=True)
    groups: dict[Path, Map] = {(): top}
    for plan in sorted(own, key=lambda plan: plan.given[config.name].line):
        for depth in range(1, len(plan.path)):
            path = plan.path[:depth]
            if path not in groups:
                groups[path] = Map(block=True)
                groups[path[:-1]].put(path[-1], groups[path])
        item = plan.given[config.name].item
        assert plan.shape is not None
        groups[plan.path[:-1]].put(plan.path[-1], written(plan.shape, item.value), item.notes)
    return top


def _legacy(config: Config, plans: Sequence[Plan], links: Links, exact: bool) -> Map:
    body = Map()
    body.put("file", links.file)
    if config.sorted.dialect != CLASSIC:
        body.put("dialect", config.sorted.dialect)
    if links.after:
        body.put("after", links.after)
    originals = Map(block=True)
    if config.sorted.dialect != TOML:
        for key, raw in _originals(config, plans, exact):
            originals.put(key, raw)
    if originals.entries:
        body.put("exact", originals)
    return body


def _originals(config: Config, plans: Sequence[Plan], exact: bool) -> Iterator[tuple[str, str]]:
    """Properties whose spelling the document would not give again; what differs in blanks only if asked for."""
    for plan in plans:
        given = plan.given.get(config.name)
        spelled = plan.spelled
        if given is None:
            continue
        separators = spelled.separators or [spelled.separator] if spelled else []
        for setting in given.settings:
            made = setting.raw
            if spelled and spelled.columns:
                made = spelled.separator.join(rows.cells(setting.raw))
            elif spelled and spelled.key.endswith("{i}"):
                made = setting.raw
            elif spelled and spelled.separators:
                made = _joined(setting.raw, spelled.separators, spelled.trailing)
            elif config.sorted.dialect == FLAT_TOML:
                made = _requoted(setting.raw, plan)
            same = rows.squeezed(made, separators) == rows.squeezed(setting.raw, separators)
            if made != setting.raw and (exact or not (same and separators)):
                yield setting.key, setting.raw
    if config.sorted.dialect == FLAT_TOML:
        found = config.sorted
        texts = [*found.endpoints, *found.proxies, *found.manager, *found.prefixes, *found.names]
        for named in [*texts, *(named for named in found.ice if isinstance(_typed(named), str))]:
            raw = named.setting.raw
            if '"' not in unquoted(raw) and raw != f'"{named.setting.text}"':
                yield named.setting.key, raw


def _joined(raw: str, separators: Sequence[str], trailing: bool) -> str:
    bare = tuple(separator.strip() for separator in separators)
    found = rows.split(raw, bare)
    parts = [part if isinstance(part, str) else separators[-1].join(part) for part in found.parts]
    return separators[0].join(parts) + (separators[0] if trailing else "")


def _requoted(raw: str, plan: Plan) -> str:
    """What flat TOML makes of a plain value: text stands in quotes."""
    shape = plan.shape
    kind = getattr(shape, "kind", "")
    return f'"{unquoted(raw)}"' if kind == STRING and '"' not in unquoted(raw) else raw
