"""Whether an Ice object answers."""

from __future__ import annotations

from robocomp_yaml.deploy import ice_call
from robocomp_yaml.deploy.ice_call import IceCall
from robocomp_yaml.wire.protocol import OK

PING = IceCall("ice_ping")


async def answers(proxy: str, within: float, pem: str = "") -> bool:
    """Whether the object of a proxy answers a ping within so many seconds. Any failure of the other end returns
    False. `pem` are a key and the certificates for an object over TLS."""
    reply = await ice_call.answer(proxy, PING, within, pem)
    return reply is not None and reply.status == OK
