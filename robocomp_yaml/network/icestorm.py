"""IceStorm, the service that carries topics: its process and its settings."""

from __future__ import annotations

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.deployment import CONFIG
from robocomp_yaml.network.draft import MANAGER, PUBLISH, STORM_INSTANCE
from robocomp_yaml.network.network import ICESTORM, LOOPBACK, ConfigFile, Endpoint, Process, Readiness
from robocomp_yaml.semantics.connections import ICE_DEFAULTS
from robocomp_yaml.source.properties import entry_line


def process(
    name: str, host: str, endpoints: tuple[Endpoint, Endpoint], proxy: str, folder: str, span: Span,
    *, enabled: bool = True, published: tuple[str, str] = ("", ""),
) -> Process:  # fmt: skip
    """The process of an IceStorm, in icebox. `endpoints` are those of the topic manager and of publishers, `published`
    what others get instead of them, if that is not ''; `proxy` is that of the topic
    manager. Its database is below `folder`, the deployment's own folder."""
    database = f"{folder}/state/{name}"
    manager, publish = endpoints
    return Process(
        name,
        host,
        ("icebox", f"--Ice.Config={CONFIG}"),
        "/",  # its paths are absolute
        ICESTORM,
        config=ConfigFile(f"config/{name}", _settings(manager.text, publish.text, database, published)),
        endpoints=endpoints,
        ready=Readiness(pings=(proxy,)),
        folders=(database,),
        enabled=enabled,
        span=span,
    )


def on_this_machine(name: str, port: int, folder: str, span: Span) -> Process:
    """An IceStorm that only this machine reaches: its topic manager at a port, its publishers at any free one."""
    endpoint = f"tcp -h 127.0.0.1 -p {port}"
    manager = Endpoint(MANAGER, f"{STORM_INSTANCE}/{MANAGER}", port, endpoint, module="IceStorm", span=span)
    publish = Endpoint(PUBLISH, "", 0, "tcp -h 127.0.0.1 -p 0", span=span)
    return process(name, LOOPBACK, (manager, publish), f"{STORM_INSTANCE}/{MANAGER}:{endpoint}", folder, span)


def _settings(manager: str, publish: str, database: str, published: tuple[str, str]) -> str:
    """The configuration of an IceStorm with these endpoints, and its database in this folder."""
    made = {
        f"IceBox.Service.{STORM_INSTANCE}": "IceStormService,37:createIceStorm",
        "IceBox.InheritProperties": "1",
        f"{STORM_INSTANCE}.InstanceName": STORM_INSTANCE,
        f"{STORM_INSTANCE}.{MANAGER}.Endpoints": manager,
        f"{STORM_INSTANCE}.{PUBLISH}.Endpoints": publish,
        f"{STORM_INSTANCE}.LMDB.Path": database,
        f"{STORM_INSTANCE}.LMDB.MapSize": "10",
        "Ice.MessageSizeMax": ICE_DEFAULTS["Ice.MessageSizeMax"],  # what a component can send, it can pass on
    }
    for adapter, text in zip((MANAGER, PUBLISH), published, strict=True):
        made |= {f"{STORM_INSTANCE}.{adapter}.PublishedEndpoints": text} if text else {}
    return "".join(f"{entry_line(key, value)}\n" for key, value in made.items())
