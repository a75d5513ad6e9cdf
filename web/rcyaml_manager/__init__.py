"""The page of `rcyaml manager`: static files, which rcyaml serves."""

from __future__ import annotations

from pathlib import Path

_STATIC = Path(__file__).parent / "static"


def files() -> dict[str, str]:
    """The paths of the files by their names; none if the page was not built (an editable installation)."""
    return {path.name: str(path) for path in sorted(_STATIC.glob("*")) if path.is_file()}
