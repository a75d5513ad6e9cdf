"""The properties of IceGrid's daemons, and the key of a deployment.

Registry, nodes, keeper and commands of a deployment communicate over TLS only, and each needs the deployment's own
certificate. So nobody else can add a node, start a program or read a configuration, although the registry listens on
the network.
"""

from __future__ import annotations

import os

from robocomp_yaml.deploy import openssl
from robocomp_yaml.deploy.icegrid.grid_files import CERTIFICATE, KEY, GridFiles, Registry

INSTANCE = "rcyaml"
_EXTENSIONS = """\
basicConstraints = critical, CA:true
subjectKeyIdentifier = hash
"""
_SESSION_TIMEOUT = "10"  # seconds after which a silent host counts as lost


# Calls to a host without a connection fail after some seconds, not after TCP's fifteen minutes. During a call, a host
# sends heartbeats.
_PATIENCE = {"Ice.ACM.Timeout": "4", "Ice.Override.ConnectTimeout": "3000"}


def make_key(files: GridFiles) -> None:
    """Creates the deployment's key and certificate, once. The certificate is valid at any time, because clocks of hosts
    can be wrong. Raises OSError if openssl is missing or fails."""
    if os.path.exists(files.key) and os.path.exists(files.certificate):
        return
    os.makedirs(files.root, mode=0o700, exist_ok=True)
    with openssl.certificate(files.root, "rcyaml", _EXTENSIONS) as work:
        os.replace(f"{work}/key", files.key)
        os.replace(f"{work}/certificate", files.certificate)


def _secured(folder: str) -> dict[str, str]:
    """The Ice properties for TLS with the deployment's key and certificate in a folder only. Ice takes each path of
    `CertFile` and `KeyFile` as a list, in which quotes and colons have a meaning."""
    return {
        "Ice.Plugin.IceSSL": "IceSSL:createIceSSL",
        "IceSSL.DefaultDir": folder,
        "IceSSL.CertFile": CERTIFICATE,
        "IceSSL.KeyFile": KEY,
        "IceSSL.CAs": CERTIFICATE,
        "IceSSL.VerifyPeer": "2",
    }


def of_registry(files: GridFiles, registry: Registry) -> dict[str, str]:
    own = f"ssl -h {registry.address}"
    return {
        **_secured(files.root),
        **_PATIENCE,
        "IceGrid.Registry.Client.ThreadPool.SizeMax": "64",
        "IceGrid.InstanceName": INSTANCE,
        "IceGrid.Registry.Client.Endpoints": f"{own} -p {registry.port}",
        # No server registers, because all proxies of a deployment are direct.
        "IceGrid.Registry.Server.Endpoints": "ssl -h 127.0.0.1",
        "IceGrid.Registry.Internal.Endpoints": own,
        # The certificate is the permission.
        "IceGrid.Registry.AdminPermissionsVerifier": f"{INSTANCE}/NullPermissionsVerifier",
        "IceGrid.Registry.NodeSessionTimeout": _SESSION_TIMEOUT,
        "IceGrid.Registry.LMDB.Path": f"{files.registry_folder}/data",
        "IceGrid.Registry.LMDB.MapSize": "100",
    }


def of_node(files: GridFiles, host: str, address: str, registry: Registry) -> dict[str, str]:
    own = f"{files.root}/nodes/{host}"
    return {
        **_secured(own),
        **_PATIENCE,
        "Ice.Default.Locator": f"{INSTANCE}/Locator:{_endpoint(registry)}",
        "IceGrid.Node.Name": host,
        "IceGrid.Node.Endpoints": f"ssl -h {address}",
        # The kernel kills a server when the thread that started it ends: threads must not end.
        "Ice.ThreadPool.Client.ThreadIdleTime": "0",
        "Ice.ThreadPool.Server.ThreadIdleTime": "0",
        "IceGrid.Node.ThreadPool.ThreadIdleTime": "0",
    }


def of_client(files: GridFiles) -> dict[str, str]:
    return {
        **_secured(files.root),
        **_PATIENCE,
        "Ice.Default.InvocationTimeout": "30000",
        "Ice.RetryIntervals": "-1",
        "Ice.ACM.Close": "2",  # only while an answer is pending
        "Ice.ACM.Heartbeat": "3",  # always: the session lives as long as its connection
        "Ice.Warn.Connections": "0",
        "Ice.LogFile": os.devnull,  # failures are reported as diagnostics
    }


def registry_proxy(registry: Registry) -> str:
    return f"{INSTANCE}/Registry:{_endpoint(registry)}"


def _endpoint(registry: Registry) -> str:
    return f"ssl -h {registry.address} -p {registry.port}"
