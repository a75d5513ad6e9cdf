"""TLS for connections without the Ice runtime: both sides show a certificate of the deployment's authority."""

from __future__ import annotations

import functools
import os
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ssl import SSLContext


def of_file(path: str) -> SSLContext:
    """A context with the key and the certificates in this file. Raises OSError, also if they are not valid."""
    with open(path, encoding="ascii") as file:
        return _context(path, file.read())


@functools.lru_cache(256)
def of_text(pem: str) -> SSLContext:
    """A context with this key and these certificates. Raises OSError, also if they are not valid."""
    held = os.memfd_create("pem")  # Python reads a key only from a file
    try:
        os.write(held, pem.encode("ascii"))
        return _context(f"/proc/self/fd/{held}", pem)
    finally:
        os.close(held)


def _context(path: str, pem: str) -> SSLContext:
    import ssl  # it is slow, and only deployments with TLS need it

    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.load_cert_chain(path)
    context.load_verify_locations(cadata=pem)
    return context
