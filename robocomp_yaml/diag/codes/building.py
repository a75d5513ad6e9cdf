"""RC8xxx: building. The diagnostics of compilers, and the reasons why a component cannot be built."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("building")

ERROR_OF_COMPILER = _PAGE.code("RC8001")
WARNING_OF_COMPILER = _PAGE.code("RC8002")
FAILED = _PAGE.code("RC8003")
NOT_COMPILED = _PAGE.code("RC8004")
