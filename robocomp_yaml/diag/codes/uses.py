"""RC23xx: `uses:`, the libraries and sources that a component's own code needs."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("cdsl")

TWO_PLACES = _PAGE.code("RC2301")
VERSION = _PAGE.code("RC2302")
OTHER_LANGUAGE = _PAGE.code("RC2303")
NOT_INSTALLED = _PAGE.code("RC2304")
NO_SOURCE = _PAGE.code("RC2305")
