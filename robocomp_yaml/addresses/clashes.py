"""TCP ports that two flat configs of a workspace set for one host."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator

from robocomp_yaml.diag.codes import emitting as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.flat_configs import FLAT
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.source import properties
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.ice_endpoint import parse_endpoint
from robocomp_yaml.source.properties import IceProperty


def clashes(components: Iterable[LinkedComponent], disk: Disk) -> list[Diagnostic]:
    """Diagnostics about endpoints of `etc/config` that cannot be used on one host at the same time."""
    diagnostics = []
    seen: dict[tuple[bool, int], list[tuple[str, str, Span]]] = {}
    for linked in sorted(components, key=lambda linked: linked.component.path):
        for name, entry in _written(linked, disk):
            endpoint = parse_endpoint(entry.value)
            if endpoint is None:
                continue
            span = Span(config_path(linked), entry.line, entry.column, entry.line, entry.column + len(entry.key))
            who = f"{linked.component.name}'s {name}"
            others = seen.setdefault((endpoint.protocol == "udp", endpoint.port), [])
            for host, other, location in others:
                if not host or not endpoint.host or host == endpoint.host:
                    diagnostics.append(
                        codes.PORT_CLASH.at(
                            span, port=endpoint.port, name=who, other=other, hint="set another port for one of them",
                            related=[Related("the same port", location)],
                        )
                    )  # fmt: skip
                    break
            others.append((endpoint.host, who, span))
    return diagnostics


def config_path(linked: LinkedComponent) -> str:
    """The path of a component's `etc/config`."""
    return os.path.join(os.path.dirname(linked.component.path), FLAT)


def _written(linked: LinkedComponent, disk: Disk) -> Iterator[tuple[str, IceProperty]]:
    """The endpoint properties of an `etc/config` by adapter, in both dialects."""
    path = config_path(linked)
    raw = disk.read(path)[0] if disk.has_file(path) else None
    for key, entry in properties.read((raw or b"").decode(errors="replace")).last.items():
        if key.startswith("Endpoints."):
            yield key.removeprefix("Endpoints."), entry
        elif key.endswith(".Endpoints"):
            yield key.removesuffix(".Endpoints"), entry
