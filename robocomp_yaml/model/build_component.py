"""Builds a `Component` from the tree of a CDSL document. The tree fits the schema."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robocomp_yaml.model import component as model
from robocomp_yaml.model.build_interface import doc, given, imports, items, span_of, text, texts
from robocomp_yaml.model.duration import seconds
from robocomp_yaml.source.tree import Mapping, Node, Scalar

if TYPE_CHECKING:
    from robocomp_yaml.model.statemachine import StateMachine


def build(root: Mapping, path: str) -> model.Component:
    """Returns the component of a document that fits `cdsl.schema.json`; `path` is the document as opened."""
    machine = root.get("statemachine")
    period = seconds(root.get("period"))
    return model.Component(
        name=text(root, "component"),
        path=path,
        language=_language(root),
        imports=imports(root),
        implements=tuple(_uses(root, "implements")),
        requires=tuple(_uses(root, "requires")),
        publishes=tuple(_uses(root, "publishes")),
        subscribes=tuple(_uses(root, "subscribes")),
        parameters=text(root, "parameters"),
        period=None if period is None else round(period * 1000),
        statemachine=text(root, "statemachine"),
        machine=_machine(machine, text(root, "component"), path) if isinstance(machine, Mapping) else None,
        gui=given(root, "gui", _gui),
        options=tuple(texts(root, "options")),
        compatibility=text(root, "compatibility"),
        sources=tuple(_sources(root.get("uses"))),
        libraries=tuple(_libraries(root.get("uses"))),
        doc=doc(root),
        machine_span=span_of(root, "statemachine"),
        span=span_of(root, "component"),
        parameters_span=span_of(root, "parameters"),
        keys_span=tuple((key.lexeme, key.span) for key, node in root.items() if node.data not in (None, "", [], {})),
    )


def _machine(node: Mapping, name: str, path: str) -> StateMachine:
    from robocomp_yaml.model.build_statemachine import build as build_machine  # few components have a machine

    return build_machine(node, name, path)


def _language(root: Mapping) -> model.Language:
    node = root.get("language")
    if isinstance(node, Mapping):
        standard = node.data.get("standard")  # type: ignore[attr-defined]
        return model.Language(
            text(node, "name"),
            None if standard is None else int(standard),
            span=node.span,
            standard_span=node.entries["standard"][0].span if standard is not None else node.span,
        )
    assert isinstance(node, Scalar)
    return model.Language(node.lexeme, span=node.span)


def _gui(node: Node) -> model.Gui:
    return model.Gui(text(node, "toolkit", "qt"), text(node, "base", "QWidget"), span=node.span)


def _uses(root: Mapping, key: str) -> Iterator[model.Use]:
    for item in items(root, key):
        if isinstance(item, Scalar):
            yield model.Use(item.lexeme.rpartition(".")[2], item.lexeme, span=item.span)
        elif isinstance(item, Mapping):
            for name, node in item.items():
                yield _named_use(name, node)


def _named_use(name: Scalar, node: Node) -> model.Use:
    if isinstance(node, Scalar):
        return model.Use(name.lexeme, node.lexeme, span=node.span, name_span=name.span)
    return model.Use(
        name.lexeme,
        text(node, "interface", name.lexeme),
        absent=text(node, "absent", model.WAIT),
        timeout=seconds(node.get("timeout")),
        doc=doc(node),
        span=span_of(node, "interface") if node.get("interface") else name.span,
        name_span=name.span,
    )


def _sources(uses: Node | None) -> Iterator[model.Source]:
    for key in ("sources", "classes"):
        for path in texts(uses, key):
            yield model.Source(path.text, key == "classes", span=path.span)


def _libraries(uses: Node | None) -> Iterator[model.Library]:
    """One library for each kind that an entry names. A check reports entries that name several."""
    for number, item in enumerate(items(uses, "libraries")):
        if isinstance(item, Mapping):
            version = text(item, "version")
            for key, node in item.items():
                if key.lexeme in (model.CMAKE, model.PKG_CONFIG, model.LINK, model.PIP):
                    version_span = (item.get("version") or node).span
                    yield model.Library(
                        key.lexeme,
                        text(item, key.lexeme),
                        version,
                        number,
                        span=node.span,
                        version_span=version_span,
                    )
