"""Where a process listens: on its host's own address, unless `listen:` of the entry or of its host says otherwise.

What others get as its address (published endpoints) is always the host's own address, as long as the process listens on
it: other addresses of the machine need not be reachable for all hosts.
"""

from __future__ import annotations

import msgspec

from robocomp_yaml.model.deployment import ADDRESS, ANY
from robocomp_yaml.network.network import LOOPBACK, NetworkHost, is_loopback
from robocomp_yaml.source.ice_endpoint import completed, spelled_host

TCP, SSL = "tcp", "ssl"


class Listening(msgspec.Struct, frozen=True):
    """The `addresses` on which a process listens, () for all; `own` is the address by which its host is reached."""

    own: str
    addresses: tuple[str, ...]
    protocol: str = TCP

    def endpoints(self, number: int) -> str:
        """The endpoints of an adapter with a TCP port. Without a fixed one, it listens only where others reach it,
        because published endpoints cannot be set."""
        addresses = self.addresses if number or not self._is_reached else (self.own,)
        if not addresses:
            return f"{self.protocol} -p {number}"
        return ":".join(f"{self.protocol} -h {spelled_host(one)} -p {number}" for one in addresses)

    def published(self, number: int) -> str:
        """The published endpoints, '' if they are those on which it listens."""
        if not number or not self._is_reached or self.addresses == (self.own,):
            return ""
        return f"{self.protocol} -h {spelled_host(self.own)} -p {number}"

    def completed(self, text: str) -> str:
        """Endpoints of a document: those without a host listen where the process listens."""
        return completed(text, self.addresses, TCP if self.protocol == TCP else SSL)

    @property
    def reached_at(self) -> str:
        """The address by which others call it."""
        return self.own if not self.addresses or self.own in self.addresses else self.addresses[0]

    @property
    def _is_reached(self) -> bool:
        """Whether it listens on the address by which other hosts reach it."""
        return not is_loopback(self.own) and (not self.addresses or self.own in self.addresses)


def listening(host: NetworkHost, listen: tuple[str, ...] = (), protocol: str = TCP) -> Listening:
    """Where a process on a host listens; `listen` is that of its entry. An endpoint never contains `localhost`, which
    can mean ::1: a machine without IPv6 cannot listen on that."""
    own = "127.0.0.1" if host.address == LOOPBACK else host.address
    chosen = listen or host.listen or (ADDRESS,)
    every = () if ANY in chosen else tuple(dict.fromkeys(own if one == ADDRESS else one for one in chosen))
    return Listening(own, every, protocol)
