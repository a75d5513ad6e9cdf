"""Where the files of a component are, relative to its folder."""

from __future__ import annotations

import os

SETTINGS = "etc"
CONFIG, SOURCES = f"{SETTINGS}/config", "src"


def is_settings(path: str) -> bool:
    """Whether a file is in a component's folder of property files."""
    return os.path.basename(os.path.dirname(path)) == SETTINGS
