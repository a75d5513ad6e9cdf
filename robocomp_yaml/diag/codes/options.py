"""RC24xx: `options:`, those of the legacy component generator."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("cdsl")

UNKNOWN_OPTION = _PAGE.code("RC2351")
LEFT = _PAGE.code("RC2352")
