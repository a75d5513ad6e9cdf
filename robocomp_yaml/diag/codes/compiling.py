"""RC61xx: documents that cannot be compiled."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("emitting")

UNRESOLVED = _PAGE.code("RC6101")
