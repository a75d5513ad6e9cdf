"""Errors for unknown names, for paths that no file can have, and for files that cannot be written."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable

from robocomp_yaml.diag.errors import Refused, reason_of
from robocomp_yaml.source.disk import Disk

_MOST = 12  # names that a message lists


def meant(word: str, known: Iterable[str], otherwise: str = "") -> str:
    """The end of a message about an unknown word: `; did you mean 'X'?`, or `otherwise` if no known word is near."""
    from robocomp_yaml.diag.suggest import suggest

    nearest = suggest(word, known)
    hint = f"did you mean '{nearest}'?" if nearest else otherwise
    return f"; {hint}" if hint else ""


def require(what: str, name: str, known: Collection[str], owner: str = "rcyaml") -> None:
    """Raises Refused if `name` is unknown. `owner` is what has the known names."""
    if name not in known:
        from robocomp_yaml.diag.listing import some

        choices = f"choose one of {some(list(known), _MOST)}"
        raise Refused(f"{owner} has no {what} '{name}'{meant(name, known, choices)}")


def require_paths(*paths: str) -> None:
    """Raises Refused if no file can have one of these paths."""
    for path in paths:
        try:
            is_possible = b"\0" not in os.fsencode(path)
        except UnicodeEncodeError:
            is_possible = False
        if not is_possible:
            raise Refused(f"{path!a} cannot be the path of a file")


def include_folders(include: Iterable[str], disk: Disk | None = None) -> tuple[str, ...]:
    """The folders of `include` or `-I`. Raises Refused if one is none."""
    folders, disk = tuple(include), disk or Disk()
    require_paths(*folders)
    for folder in folders:
        if not disk.has_folder(folder):
            raise Refused(
                f"'{folder}' is not a folder" if os.path.lexists(folder) else f"there is no folder '{folder}'"
            )
    return folders


def cannot_write(path: str, error: OSError) -> Refused:
    """The error to raise if a file cannot be written."""
    return Refused(f"cannot write {path}: {reason_of(error)}")


def without_ice() -> None:
    """Raises Refused if Ice for Python is not installed."""
    import sys
    from importlib.util import find_spec

    import robocomp_yaml.wire  # noqa: F401 - it knows where Ice is
    from robocomp_yaml.diag import extras

    if find_spec("Ice") is None:
        raise Refused(
            f"the Python of rcyaml ({sys.executable}) has no Ice: Debian has python3-zeroc-ice for its own Python, "
            f"else {extras.command('ice')}"
        )
