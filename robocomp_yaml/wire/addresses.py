"""Where stand-ins serve and publish."""

from __future__ import annotations

import msgspec


class Address(msgspec.Struct, frozen=True):
    """Where an interface is served: at an endpoint of Ice, under an identity. `users` are those who expect it there."""

    endpoint: str
    identity: str
    users: tuple[str, ...] = ()


class Topic(msgspec.Struct, frozen=True):
    """A topic of an IceStorm, which the proxy of its topic manager names."""

    manager: str
    name: str
