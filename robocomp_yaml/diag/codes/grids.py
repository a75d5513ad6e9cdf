"""RC702x: deploying with IceGrid. Failures of its registry and nodes."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("deploying")

NO_REGISTRY = _PAGE.code("RC7020")
NO_NODE = _PAGE.code("RC7021")
