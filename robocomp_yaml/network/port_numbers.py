"""Default ports: a hash of two names, and what moves on when two of them meet.

The range 10000–29999 lies above IceStorm's usual 9999 and RoboComp's habits, and below the ports that Linux hands out
by itself (32768 and up).
"""

from __future__ import annotations

import zlib

FIRST, COUNT = 10000, 20000
COMMON_BEHAVIOR = "CommonBehavior"

RESERVED = frozenset((11311, 11345))
"""The masters of ROS 1 and Gazebo, which often run beside."""


def default_port(owner: str, interface: str) -> int:
    """`owner` is a component's name, or that of its instance in a deployment."""
    return FIRST + zlib.crc32(f"{owner}/{interface}".encode()) % COUNT


def next_free(port: int, taken: set[int]) -> int:
    while port in taken:
        port = FIRST + (port + 1 - FIRST) % COUNT
    return port
