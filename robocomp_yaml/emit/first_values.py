"""The text of a component's first values document, with the endpoints and proxies that it will need."""

from __future__ import annotations

import os
from pathlib import Path

from robocomp_yaml.emit import ports
from robocomp_yaml.link.program import LinkedParameters
from robocomp_yaml.values.new import new_document


def first_values(linked: LinkedParameters, component: str, target: str) -> str:
    """`component` is the path of the CDSL (or PDSL), `target` that of the document to be."""
    folder = os.path.dirname(target) or "."
    where = Path(os.path.relpath(component, folder)).as_posix()
    schema = Path(os.path.relpath(os.path.join(os.path.dirname(component), "generated", "config.schema.json"), folder))
    modeline = f"# yaml-language-server: $schema={schema.as_posix()}"
    return new_document(linked.parameters, where, modeline, _connections(linked))


def _connections(linked: LinkedParameters) -> list[tuple[str, list[tuple[str, str]]]]:
    component = linked.component
    if component is None:
        return []
    table = ports.assign([component])
    served = [(name, f"tcp -p {table.endpoint(component, name).port}") for name in ports.adapters(component)]
    served += [(f"{port.name}Topic", "tcp -p 0") for port in component.subscribes]
    proxies = [
        (port.name, f"{port.interface.name.lower()}:tcp -h localhost -p {ports.default_port('', port.interface.name)}")
        for port in component.requires
    ]
    return [("endpoints", served), ("proxies", proxies)]
