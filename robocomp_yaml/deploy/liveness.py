"""What a supervisor asks a process, to know whether it is alive: the heartbeat of a component, a ping of others.

A component of an earlier version, and a program that does not describe itself, answer that they have no such facet.
That is an answer, too.
"""

from __future__ import annotations

from robocomp_yaml.network.network import Liveness

START, READY = 60.0, 3
"""Seconds that a process has for its first answer after a start; and that many times the limit of `ready:`, if that is
longer."""


def question(alive: Liveness | None, *, is_secured: bool = False) -> tuple[str, int, str] | None:
    """The host, port and message, in hexadecimal digits. None if nothing is asked, also because the process serves
    nothing over TCP. One that `is_secured` is asked over TLS."""
    if alive is None:
        return None
    from robocomp_yaml.deploy import ice_call  # unused by programs
    from robocomp_yaml.wire import introspection, protocol

    protocols = ice_call.SECURE if is_secured else ice_call.PLAIN
    address = ice_call.address_of(alive.proxy, protocols)
    if address is None:
        return None
    identity, host, port = address
    return host, port, protocol.request(identity, introspection.HEARTBEAT, introspection.FACET).hex()
