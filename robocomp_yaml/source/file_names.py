"""What the name of a file says, and how long it and its path can be: in bytes, as Linux counts them."""

from __future__ import annotations

import os

WORKSPACE_FILE = "rcyaml.yaml"
LONGEST_NAME = 255
LONGEST_PATH = 4095


def is_deployment(path: str) -> bool:
    """Whether a document is a deployment."""
    return f"/{path}".endswith((".ddsl.yaml", "/ddsl.yaml"))


def with_document(path: str) -> str:
    """What a command takes as PATH to concern a document: the shared files of a workspace come with its folder."""
    return os.path.dirname(path) or os.curdir if os.path.basename(path) == WORKSPACE_FILE else path


def size(text: str) -> int:
    return len(text.encode(errors="surrogateescape"))


def is_too_long(name: str) -> bool:
    """Whether the name has more bytes than a file name may have."""
    return size(name) > LONGEST_NAME


def path_fault(path: str) -> str:
    """Why a path is too long for the system, or ''."""
    for part in path.split("/"):
        if is_too_long(part):
            return f"a name in it has {size(part)} bytes, more than {LONGEST_NAME}"
    return f"it has {size(path)} bytes, more than {LONGEST_PATH}" if size(path) > LONGEST_PATH else ""


def shortened(text: str) -> str:
    """The text with at most 40 characters, for messages."""
    return text if len(text) <= 40 else f"{text[:37]}…"
