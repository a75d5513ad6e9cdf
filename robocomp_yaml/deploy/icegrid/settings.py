"""The properties of IceGrid's daemons, and the key by which those of one deployment know each other.

Registry, nodes, keeper and commands of a deployment talk over TLS only, and each must show the deployment's own
certificate: nobody else can add a node, start a program or look at a configuration, also where the registry listens on
the network.
"""

from __future__ import annotations

import os
import subprocess

from robocomp_yaml.deploy.icegrid.places import Places, Registry

INSTANCE = "rcyaml"
_VALID_DAYS = "36500"
_SESSION_TIMEOUT = "10"  # seconds after which a host that says nothing counts as lost


# A host that is cut off says nothing: calls to it fail after some seconds, and not after TCP's quarter of an hour. One
# that works on a call sends heartbeats all the while.
_PATIENCE = {"Ice.ACM.Timeout": "4", "Ice.Override.ConnectTimeout": "3000"}


def make_key(places: Places) -> None:
    """The deployment's key and certificate, made once. Raises OSError where openssl is not there or fails."""
    if os.path.exists(places.key) and os.path.exists(places.certificate):
        return
    os.makedirs(places.root, mode=0o700, exist_ok=True)
    mask = os.umask(0o077)
    try:
        done = subprocess.run(
            ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes",
             "-days", _VALID_DAYS, "-subj", "/CN=rcyaml", "-keyout", places.key, "-out", places.certificate],
            capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL,
        )  # fmt: skip
    finally:
        os.umask(mask)
    if done.returncode:
        raise OSError(0, f"openssl makes no key: {done.stderr.strip()[-300:]}")


def secured(key: str, certificate: str) -> dict[str, str]:
    """What makes a program of Ice speak TLS as one of the deployment, and with nobody else."""
    return {
        "Ice.Plugin.IceSSL": "IceSSL:createIceSSL",
        "IceSSL.CertFile": certificate,
        "IceSSL.KeyFile": key,
        "IceSSL.CAs": certificate,
        "IceSSL.VerifyPeer": "2",
    }


def of_registry(places: Places, registry: Registry) -> dict[str, str]:
    own = f"ssl -h {registry.address}"
    return {
        **secured(places.key, places.certificate),
        **_PATIENCE,
        "IceGrid.Registry.Client.ThreadPool.SizeMax": "64",
        "IceGrid.InstanceName": INSTANCE,
        "IceGrid.Registry.Client.Endpoints": f"{own} -p {registry.port}",
        # No server registers: all proxies of a deployment are direct.
        "IceGrid.Registry.Server.Endpoints": "ssl -h 127.0.0.1",
        "IceGrid.Registry.Internal.Endpoints": own,
        # The certificate is what gives access.
        "IceGrid.Registry.AdminPermissionsVerifier": f"{INSTANCE}/NullPermissionsVerifier",
        "IceGrid.Registry.NodeSessionTimeout": _SESSION_TIMEOUT,
        "IceGrid.Registry.LMDB.Path": f"{places.registry_folder}/data",
        "IceGrid.Registry.LMDB.MapSize": "100",
    }


def of_node(places: Places, host: str, address: str, registry: Registry) -> dict[str, str]:
    own = f"{places.root}/nodes/{host}"
    return {
        **secured(f"{own}/key.pem", f"{own}/certificate.pem"),
        **_PATIENCE,
        "Ice.Default.Locator": f"{INSTANCE}/Locator:{_endpoint(registry)}",
        "IceGrid.Node.Name": host,
        "IceGrid.Node.Endpoints": f"ssl -h {address}",
        # A server is tied to the thread that started it: threads must not end.
        "Ice.ThreadPool.Client.ThreadIdleTime": "0",
        "Ice.ThreadPool.Server.ThreadIdleTime": "0",
        "IceGrid.Node.ThreadPool.ThreadIdleTime": "0",
    }


def of_client(places: Places) -> dict[str, str]:
    return {
        **secured(places.key, places.certificate),
        **_PATIENCE,
        "Ice.Default.InvocationTimeout": "30000",
        "Ice.RetryIntervals": "-1",
        "Ice.ACM.Close": "2",  # only where an answer is awaited
        "Ice.ACM.Heartbeat": "3",  # always: the session lives as long as its connection
        "Ice.Warn.Connections": "0",
    }


def registry_proxy(registry: Registry) -> str:
    return f"{INSTANCE}/Registry:{_endpoint(registry)}"


def _endpoint(registry: Registry) -> str:
    return f"ssl -h {registry.address} -p {registry.port}"
