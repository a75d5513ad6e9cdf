# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""The properties that connect components: under which names a configuration says endpoints, proxies and topics.

The first name of each is Ice's way to say it, others are RoboComp's. The first that has a value counts.
"""

from __future__ import annotations

from collections.abc import Callable

from .texts import unquoted

MANAGER = ("TopicManager.Proxy", "Proxies.TopicManager")
"""The proxy to IceStorm's topic manager."""


def endpoints(adapter: str) -> tuple[str, str]:
    return f"{adapter}.Endpoints", f"Endpoints.{adapter}"


def topic_endpoints(port: str) -> tuple[str, str, str]:
    """Of the adapter through which a component hears a topic."""
    return (*endpoints(f"{port}Topic"), f"Endpoints.{port}")


def proxy(port: str) -> tuple[str, str]:
    return f"{port}Proxy", f"Proxies.{port}"


def prefix(port: str) -> str:
    """What the topic's name begins with; the port that publishes it is called with `Pub` behind its name."""
    return f"Proxies.{port}Prefix"


def first(get: Callable[[str], str | None], *keys: str) -> str:
    """The value of the first of the keys that has one, or ''."""
    return next((value for key in keys if (value := unquoted(get(key) or ""))), "")


def topic(before: str, own: str, interface: str) -> str:
    """The name of a topic: one of its own, else the interface's, behind the prefix where there is one."""
    return f"{before}/{own or interface}" if before else own or interface
