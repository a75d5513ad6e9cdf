"""The table of codes, with a module for each family. Each constant of these modules is a code, which a page of
`docs/diagnostics/` describes.

RC0xxx files and YAML · RC1xxx IDSL · RC2xxx CDSL · RC3xxx PDSL and values · RC4xxx DDSL · RC5xxx migration · RC6xxx
emitting · RC7xxx deploying · RC8xxx building · RC9xxx calls. Within a family, numbers have no meaning; a retired number
is never used again.
"""

from __future__ import annotations

from functools import cache

from robocomp_yaml.diag.code import KNOWN, Code
from robocomp_yaml.registry import Modules


@cache
def table() -> dict[str, Code]:
    """Every code by its id, in order of ids. Raises ValueError if two codes have the same id."""
    codes: dict[str, Code] = {}
    for module in Modules(__name__, "family").every():
        for code in vars(module).values():
            if isinstance(code, Code) and codes.setdefault(code.id, code) is not code:
                raise ValueError(f"two diagnostics have the code {code.id}")
    return dict(sorted(codes.items()))


def row_of(id_: str) -> Code:
    """The code of this id. The family of a diagnostic is usually imported already; that of a plug-in always is."""
    return KNOWN.get(id_) or table()[id_]


@cache
def message_of(id_: str) -> str:
    """The message of a code, a format string."""
    return row_of(id_).message
