"""Default TCP ports: a hash of two names in a range of ports, or the next free port if another process has it.

The usual range, 10000–29999, is above IceStorm's usual 9999 and RoboComp's usual ports, and below the ports that Linux
assigns by itself (32768 and up).
"""

from __future__ import annotations

import zlib
from collections.abc import Iterable

from robocomp_yaml.diag.codes import emitting as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.model.port_range import PortRange

COMMON_BEHAVIOR = "CommonBehavior"

RESERVED = frozenset((11311, 11345))
"""The ports of the masters of ROS 1 and Gazebo, which often run on the same machine."""

USUAL = PortRange(10000, 29999)


def default_port(owner: str, interface: str, ports: PortRange = USUAL) -> int:
    """A port by two names. `owner` is the name of a component, or of its instance in a deployment."""
    return ports.first + zlib.crc32(f"{owner}/{interface}".encode()) % ports.count


class FreePorts:
    """The ports of one host. `missing` are the names that found their range full, by the range."""

    def __init__(self, taken: Iterable[int] = ()) -> None:
        self.taken = {*RESERVED, *taken}
        self.missing: dict[PortRange, list[str]] = {}

    def assign(self, owner: str, interface: str, ports: PortRange = USUAL) -> int:
        """The default port of two names, or the first after it that is not taken; the port after the last is the first.
        0 if all ports of the range are taken. The port is taken then."""
        start = default_port(owner, interface, ports) - ports.first
        for step in range(ports.count):
            number = ports.first + (start + step) % ports.count
            if number not in self.taken:
                self.taken.add(number)
                return number
        self.missing.setdefault(ports, []).append(f"{owner}'s {interface}")
        return 0

    def diagnostics(self) -> Iterable[Diagnostic]:
        for ports, names in self.missing.items():
            hint = f"make it larger by {len(names)} at least, or set ports outside of it"
            yield codes.RANGE_FULL.at(ports.span, ports=str(ports), name=names[0], hint=hint)


def usable(ports: PortRange | None) -> PortRange | None:
    """The range, None if it is not set, or empty."""
    return ports if ports is not None and not ports.is_empty else None
