"""Errors for unknown names, and for files that cannot be written."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from robocomp_yaml.diag.errors import Refused, reason_of
from robocomp_yaml.diag.suggest import suggest


def meant(word: str, known: Iterable[str], otherwise: str = "") -> str:
    """The end of a message about an unknown word: `; did you mean 'X'?`, or `otherwise` if no known word is near."""
    nearest = suggest(word, known)
    hint = f"did you mean '{nearest}'?" if nearest else otherwise
    return f"; {hint}" if hint else ""


def require(what: str, name: str, known: Collection[str], owner: str = "rcyaml") -> None:
    """Raises Refused if `name` is unknown. `owner` is what has the known names."""
    if name not in known:
        choices = f"choose one of {', '.join(known)}"
        raise Refused(f"{owner} has no {what} '{name}'{meant(name, known, choices)}")


def cannot_write(path: str, error: OSError) -> Refused:
    """The error to raise if a file cannot be written."""
    return Refused(f"cannot write {path}: {reason_of(error)}")


def without_ice() -> None:
    """Raises Refused if Ice for Python is not installed."""
    from importlib.util import find_spec

    if find_spec("Ice") is None:
        raise Refused("Ice for Python is not installed: Debian has python3-zeroc-ice, pip has zeroc-ice")
