"""How long the name of a file can be, and its path: in bytes, as Linux counts them."""

from __future__ import annotations

LONGEST_NAME = 255
LONGEST_PATH = 4095


def size(text: str) -> int:
    return len(text.encode(errors="surrogateescape"))


def is_too_long(name: str) -> bool:
    """Whether no file can have this name."""
    return size(name) > LONGEST_NAME


def path_fault(path: str) -> str:
    """Why no file can have this path, or ''."""
    for part in path.split("/"):
        if is_too_long(part):
            return f"a name in it has {size(part)} bytes, and {LONGEST_NAME} are the most"
    return f"it has {size(path)} bytes, and {LONGEST_PATH} are the most" if size(path) > LONGEST_PATH else ""


def shortened(text: str) -> str:
    """For messages."""
    return text if len(text) <= 40 else f"{text[:37]}…"
