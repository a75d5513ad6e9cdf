# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""The properties that connect components: the names of endpoints, proxies and topics in a configuration, and what Ice
is set to.

The first name of each is Ice's, the others are RoboComp's. The first one that has a value is used.
"""

from __future__ import annotations

from collections.abc import Callable

from .texts import unquoted

ICE_DEFAULTS = {
    "Ice.MessageSizeMax": "20004800",  # KiB; as in RoboComp, so that an image is not too large
    "Ice.Warn.UnknownProperties": "0",  # parameters may begin with an adapter's name: `Laser.Device`
    "CommonBehavior.ThreadPool.Size": "1",  # a thread of its own, so that it answers while a method runs
    "CommonBehavior.ThreadPool.SizeMax": "4",  # more, so that a new parameter's listener does not silence it
}
"""Ice's defaults are replaced by these, unless the configuration sets them. The run times of other languages have the
same table."""

MANAGER = ("TopicManager.Proxy", "Proxies.TopicManager")
"""The proxy to IceStorm's topic manager."""


TOKEN, CONTROL, OPEN = "RcYaml.Token", "RcYaml.Control", "open"
"""The token that allows to control a component, and the property that opens that to everybody, with its value."""

TOKEN_CONTEXT = "rcyaml.token"
"""The key of the token in the context of a call."""

OWN = ("Ice.", "IceSSL.", "RcYaml.")
"""The beginnings of properties that are no parameters."""

NO_TOKEN = (
    "this component is controlled with the token of its deployment, which `rcyaml param`, `rcyaml call` and "
    "`rcyaml deploy` send for the user who started it; `control: open` in the deployment's document allows everybody"
)
PLAIN = (
    "it comes from another host ({caller}), which needs TLS to control this component: call it on its own host, or "
    "write `security: tls` in the deployment's document; `control: open` there allows everybody"
)
ELSEWHERE = (
    "it comes from another host ({caller}), and this component runs outside of a deployment, so that only its own "
    "machine controls it; `--RcYaml.Control=open` on its command line allows everybody"
)
"""Why a call is rejected. The run times of other languages have the same texts."""


OLDEST = "Comp"
"""What the oldest version of RoboComp's tool added to the names of adapters."""


def endpoints(adapter: str) -> tuple[str, str, str]:
    return f"{adapter}.Endpoints", f"Endpoints.{adapter}", f"{adapter}{OLDEST}.Endpoints"


def topic_endpoints(port: str) -> tuple[str, str, str]:
    """The endpoints of the adapter with which a component subscribes to a topic."""
    return (*endpoints(f"{port}Topic")[:2], f"Endpoints.{port}")


def proxy(port: str) -> tuple[str, str]:
    return f"{port}Proxy", f"Proxies.{port}"


def prefix(port: str) -> str:
    """The property with the prefix of the topic's name. The name of a port that publishes ends in `Pub`."""
    return f"Proxies.{port}Prefix"


def first(get: Callable[[str], str | None], *keys: str) -> str:
    """The value of the first key that has one, without quotes; '' where none has."""
    return next((value for key in keys if (value := unquoted(get(key) or ""))), "")


def topic(before: str, own: str, interface: str) -> str:
    """The name of a topic: its own or else the interface's, after the prefix if there is one."""
    return f"{before}/{own or interface}" if before else own or interface
