"""The certificates of a deployment with `security: tls`: one for each host, one for its user's commands, and the
authority that signs them.

All are in the folder of the user's state, and only there is the authority's key. A process has the key of its host in a
file beside its configuration, which `down` removes.

A certificate is valid for YEARS. When it ends within RENEWED, the next `up` makes a new one.
"""

from __future__ import annotations

import contextlib
import datetime
import ipaddress
import os
import time
from collections.abc import Iterable, Mapping

import msgspec

from robocomp_yaml.deploy import openssl, registered
from robocomp_yaml.deploy.own_address import towards_address
from robocomp_yaml.network.network import LOOPBACK, Network
from robocomp_yaml.transactions import whole_file

OPERATOR = "commands"
"""The certificate of the user's commands, for the addresses of this machine: IceStorm sends them topics."""

YEARS = 10
RENEWED = 365 * 86400.0  # seconds
_DAY = 86400.0
_NOT_BEFORE = 1767225600.0  # 2026: an earlier time is that of a clock that was not set
_HERE = ("localhost", "127.0.0.1", "::1")
_AUTHORITY = """\
basicConstraints = critical, CA:true
keyUsage = critical, keyCertSign, cRLSign
subjectKeyIdentifier = hash
"""
_MEMBER = """\
basicConstraints = critical, CA:false
keyUsage = critical, digitalSignature
extendedKeyUsage = serverAuth, clientAuth
subjectKeyIdentifier = hash
authorityKeyIdentifier = keyid
subjectAltName = {names}
"""


class Certificate(msgspec.Struct, frozen=True):
    """A certificate that was made: for which names and addresses, and when it ends (seconds since 1970)."""

    names: tuple[str, ...]
    end: float


class Authority:
    """The certificates of the deployment in a folder."""

    def __init__(self, folder: str) -> None:
        self._folder = registered.authority(folder)

    def pem(self, name: str) -> str:
        """The key and the certificates of a host, or of OPERATOR; '' if there are none."""
        with contextlib.suppress(OSError), open(self.path(name), encoding="ascii") as file:
            return file.read()
        return ""

    def path(self, name: str) -> str:
        return f"{self._folder}/{name}.pem"

    def make(self, hosts: Mapping[str, Iterable[str]]) -> None:
        """Makes what is `due`, and the authority. Raises OSError."""
        due = self.due(hosts)
        if not due:
            return
        registered.make_folder(self._folder)
        known = self._index()
        if not self.exists:
            known = {}
            self._make_authority()
        for name, names in due.items():
            known[name] = self._make(name, names)
        whole_file.put(f"{self._folder}/index.json", msgspec.json.encode(known), 0o600)

    def due(self, hosts: Mapping[str, Iterable[str]]) -> dict[str, tuple[str, ...]]:
        """The certificates of these hosts, by the names and addresses at which they are called, that are missing, end
        soon, or are for other names."""
        every = {name: tuple(sorted({*names, *_HERE})) for name, names in hosts.items()}
        known = self._index() if self.exists else {}
        return {
            name: names for name, names in every.items()
            if (one := known.get(name)) is None or one.names != names or one.end < time.time() + RENEWED
            or not os.path.exists(self.path(name))
        }  # fmt: skip

    @property
    def exists(self) -> bool:
        return all(os.path.exists(f"{self._folder}/authority.{end}") for end in ("key", "crt"))

    def _index(self) -> dict[str, Certificate]:
        return registered.read(f"{self._folder}/index.json", dict[str, Certificate]) or {}

    def _make_authority(self) -> None:
        with openssl.certificate(self._folder, "rcyaml", _AUTHORITY) as work:
            self._keep(work, "key", "authority.key")
            self._keep(work, "certificate", "authority.crt")

    def _make(self, name: str, names: tuple[str, ...]) -> Certificate:
        end = max(time.time(), _NOT_BEFORE) + YEARS * 365 * _DAY
        text = datetime.datetime.fromtimestamp(end, datetime.UTC).strftime("%Y%m%d%H%M%SZ")
        extensions, own = _MEMBER.format(names=", ".join(map(_alternative, names))), f"{self._folder}/authority"
        with openssl.certificate(self._folder, name[:60], extensions, end=text, signer=own) as work:
            parts = [f"{work}/key", f"{work}/certificate", f"{own}.crt"]
            whole_file.put(self.path(name), b"".join(map(_read, parts)), 0o600)
        return Certificate(names, end)

    def _keep(self, work: str, name: str, target: str) -> None:
        whole_file.put(f"{self._folder}/{target}", _read(f"{work}/{name}"), 0o600)


def names_at(network: Network, host: str, own: str = "") -> set[str]:
    """The names and addresses at which the processes of a host are called; `own` is the address of its name."""
    one = network.hosts[host]
    at = {one.address, own, *one.listen}
    for process in network.processes.values():
        if process.host == host:
            at |= {found.host for endpoint in process.endpoints for found in _endpoints(endpoint.text)}
    return at - {"", LOOPBACK, "address", "any"}


def _endpoints(text: str):  # type: ignore[no-untyped-def]
    from robocomp_yaml.source.ice_endpoint import parse_endpoints
    from robocomp_yaml.source.ice_options import InvalidIceText

    try:
        return parse_endpoints(text)
    except InvalidIceText:
        return ()


def properties(path: str) -> dict[str, str]:
    """The Ice properties for TLS with the key and the certificates in this file. Each side verifies the other one, and
    callers verify the name or the address that they call."""
    return {
        "Ice.Plugin.IceSSL": "IceSSL:createIceSSL",
        "IceSSL.DefaultDir": os.path.dirname(path),
        "IceSSL.CertFile": (name := os.path.basename(path)),  # a list of paths for Ice
        "IceSSL.CAs": name,
        "IceSSL.VerifyPeer": "2",
        "IceSSL.CheckCertName": "1",
        "IceSSL.Protocols": "tls1_2, tls1_3",
    }


def _alternative(name: str) -> str:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return f"DNS:{name}"
    return f"IP:{name}"


def _read(path: str) -> bytes:
    with open(path, "rb") as file:
        return file.read()


def of_commands(network: Network) -> dict[str, str]:
    """The Ice properties of the user's commands towards a deployment, empty without certificates."""
    made = Authority(network.folder)
    if not made.exists:
        return {}
    with contextlib.suppress(OSError):  # an earlier certificate may do
        made.make({OPERATOR: {towards_address(host.address) for host in network.hosts.values()}})
    path = made.path(OPERATOR)
    return properties(path) if os.path.exists(path) else {}
