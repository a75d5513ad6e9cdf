"""The digest by which contents are compared: manifests and stamps."""

from __future__ import annotations

from hashlib import blake2b


def digest(data: bytes) -> str:
    return blake2b(data, digest_size=16).hexdigest()
