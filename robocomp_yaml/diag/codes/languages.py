"""RC206x: what a component's language does not support."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("cdsl")

NOT_AVAILABLE = _PAGE.code("RC2060")
IMPOSSIBLE_NAME = _PAGE.code("RC2061")
NOT_MERGED = _PAGE.code("RC2062")
