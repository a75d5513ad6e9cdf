"""What a process is configured with, value by value: where each comes from, and what it overrides."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from typing import TYPE_CHECKING

from robocomp_yaml import secrets
from robocomp_yaml.addresses.workspaces import Addresses
from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.draft import Draft
from robocomp_yaml.parameters.documents import LayeredValues
from robocomp_yaml.parameters.editing.settings import DEFAULT, DERIVED, SET, OverriddenValue, ShownSetting
from robocomp_yaml.parameters.layers.settings import Setting, settings
from robocomp_yaml.source.tree import Node, Scalar
from robocomp_yaml.source.yaml_text import flow

if TYPE_CHECKING:
    from robocomp_yaml.parameters.editing.show import Value
    from robocomp_yaml.parameters.layers.effective import Effective


class ProcessSettings:
    """Makes the settings of one draft, from the layers of its configuration. `external` are the proxies of servers
    outside."""

    def __init__(self, draft: Draft, addresses: Addresses, external: Collection[str]) -> None:
        self._draft, self._addresses, self._external = draft, addresses, external

    def of(self, layers: LayeredValues, values: Effective | None) -> Iterator[ShownSetting]:
        for one in settings(layers):
            yield self._setting(one)
        if values is None:
            return
        from robocomp_yaml.parameters.editing.show import shown  # programs have no parameters

        for row in shown(values, reveal=False):
            yield self._parameter(row)

    def derived(self, pairs: Iterable[tuple[str, str, Span]]) -> Iterator[ShownSetting]:
        """The settings of a configuration without layers: names and texts of properties."""
        for key, text, span in pairs:
            source, where = self._source(span)
            yield ShownSetting(key, secrets.value(key, text), source, where)

    def _setting(self, one: Setting) -> ShownSetting:
        source, span = self._source(one.node.span)
        found = self._overridden(one.node, one.overrode)
        overrode = tuple(OverriddenValue(secrets.value(one.key, _spelled(node)), node.span) for node in found)
        is_outside = one.section == "proxies" and source == SET and one.name in self._external
        is_chosen = source == DERIVED and bool(overrode) and self._is_chosen(one, found)
        return ShownSetting(
            one.key, secrets.value(one.key, one.node.lexeme), source, span, overrode, is_outside,
            is_chosen or (is_outside and self._is_own(one.node.span)),
        )  # fmt: skip

    def _parameter(self, row: Value) -> ShownSetting:
        text = f"{row.text} {row.unit}" if row.unit else row.text
        if row.node is None:
            where = row.default.span if row.default is not None else None
            return ShownSetting(row.path, text, DEFAULT, where, data=row.data)
        source, span = self._source(row.node.span)
        overrode = tuple(OverriddenValue(flow(row.hide(node.data)), node.span) for node in row.overrode)
        return ShownSetting(row.path, text, source, span, overrode, data=row.data)

    def _source(self, span: Span) -> tuple[str, Span | None]:
        return (DERIVED, None) if span == self._draft.span else (SET, span)

    def _overridden(self, node: Node, earlier: Iterable[Node]) -> list[Node]:
        """The nodes that a value replaces: not the one from which it comes."""
        place = (node.span.file, node.span.line)
        return [one for one in earlier if (one.span.file, one.span.line) != place]

    def _is_own(self, span: Span) -> bool:
        """Whether a location is in the component's own configuration."""
        return span.file != self._draft.span.file

    def _is_as_written(self, key: str) -> bool:
        flat = self._draft.base.flat
        return flat is not None and flat.is_as_written(key)

    def _is_chosen(self, one: Setting, overridden: Iterable[Node]) -> bool:
        """Whether what a setting replaces is the user's choice, not what rcyaml writes if nobody sets it."""
        if not any(self._is_own(node.span) for node in overridden):
            return False
        component, own = self._draft.instance.component, self._draft.own
        if component is None or self._is_as_written(one.key):
            return False
        if one.section == "endpoints":
            return self._addresses.own_endpoint(component, own, one.name) is not None
        port = next((port for port in component.requires if port.name == one.name), None)
        if one.section == "proxies" and port is not None:
            return self._addresses.own_proxy(component, own, port) is not None
        return bool(self._draft.base.manager) or one.name != "manager"


def _spelled(node: Node) -> str:
    return node.lexeme if isinstance(node, Scalar) else flow(node.data)
