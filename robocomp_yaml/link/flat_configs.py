"""A component's flat `etc/config`."""

from __future__ import annotations

import os
from collections.abc import Mapping

import msgspec

from robocomp_yaml.patterns import pattern
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.properties import IceProperty

FLAT = os.path.join("etc", "config")

EARLIER = {
    "Ice.Warn.Connections": "0", "Ice.Trace.Network": "0", "Ice.Trace.Protocol": "0", "Ice.MessageSizeMax": "20004800",
}  # fmt: skip
"""What earlier versions of rcyaml wrote in every first `etc/config`: defaults of Ice, and of the run time of today."""

_ADDRESS = pattern(r"\.Endpoints\Z|Proxy\Z")


class FlatConfig(msgspec.Struct, frozen=True):
    """A flat config as Ice reads it: its effective `entries`, and their values, `properties`. `is_written`: rcyaml
    wrote the file, and the user may have changed it; `is_unchanged`: nobody did. `base` are the properties as rcyaml
    wrote them, without those that a values document states; empty if they are unknown."""

    path: str
    text: str
    entries: Mapping[str, IceProperty] = {}
    properties: Mapping[str, str] = {}
    base: Mapping[str, str] = {}
    is_written: bool = False
    is_unchanged: bool = False

    def is_as_written(self, key: str) -> bool:
        """Whether a property is still as rcyaml wrote it. The interface of an address may have been renamed."""
        if key not in self.properties:
            return False
        if key not in self.base and (kind := _ADDRESS.search(key)):
            former = (other for other in self.base if other.endswith(kind[0]) and other not in self.properties)
            return any(self.base[other] == self.properties[key] for other in former)
        return self.base.get(key) == self.properties[key]


def flat_config(folder: str, disk: Disk) -> FlatConfig | None:
    """The `etc/config` of the component in a folder; None if there is none that can be read."""
    return flat_at(os.path.normpath(os.path.join(folder, FLAT)), disk)


def flat_at(path: str, disk: Disk) -> FlatConfig | None:
    """The flat config at a path; None if there is none that can be read."""
    raw = disk.read(path)[0] if disk.has_file(path) else None
    if raw is None:
        return None
    from robocomp_yaml.link import flat_reading  # few components have a flat config

    return disk.once(("flat config", path, raw), lambda: flat_reading.config(path, raw, disk))
