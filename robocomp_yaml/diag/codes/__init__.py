"""The table of codes, one module a family; a constant of these modules is a row, whose text stands on a page of
`docs/diagnostics/`.

RC0xxx files and YAML · RC1xxx IDSL · RC2xxx CDSL · RC3xxx PDSL and values · RC4xxx DDSL · RC5xxx migration ·
RC6xxx emitting · RC7xxx deploying · RC8xxx building · RC9xxx calls. Within a family the number says nothing; a
retired number stays retired.
"""

from __future__ import annotations

from functools import cache

from robocomp_yaml.diag.code import KNOWN, Code
from robocomp_yaml.registry import Modules


@cache
def table() -> dict[str, Code]:
    """Every row by its id, in order of id. Raises ValueError when two rows share an id."""
    rows: dict[str, Code] = {}
    for module in Modules(__name__, "family").every():
        for row in vars(module).values():
            if isinstance(row, Code):
                if row.id in rows:
                    raise ValueError(f"two diagnostics are called {row.id}")
                rows[row.id] = row
    return dict(sorted(rows.items()))


def row_of(id_: str) -> Code:
    """The code of this id. Most often its family is imported, since it made the diagnostic; a plug-in's always is."""
    return KNOWN.get(id_) or table()[id_]


@cache
def message_of(id_: str) -> str:
    """The message of a code, a format string."""
    return row_of(id_).message
