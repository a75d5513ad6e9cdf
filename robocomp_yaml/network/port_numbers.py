"""Default TCP ports: a hash of two names, or the next free port if another process has it.

The range 10000–29999 is above IceStorm's usual 9999 and RoboComp's usual ports, and below the ports that Linux assigns
by itself (32768 and up).
"""

from __future__ import annotations

import zlib

FIRST, COUNT = 10000, 20000
COMMON_BEHAVIOR = "CommonBehavior"

RESERVED = frozenset((11311, 11345))
"""The ports of the masters of ROS 1 and Gazebo, which often run on the same machine."""


def default_port(owner: str, interface: str) -> int:
    """A port by two names. `owner` is the name of a component, or of its instance in a deployment."""
    return FIRST + zlib.crc32(f"{owner}/{interface}".encode()) % COUNT


def next_free(port: int, taken: set[int]) -> int:
    """This port, or the first after it that is not taken; the port after the last is the first."""
    while port in taken:
        port = FIRST + (port + 1 - FIRST) % COUNT
    return port
