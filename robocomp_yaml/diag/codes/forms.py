"""RC25xx: forms, the windows of components."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("cdsl")

NOT_A_FORM = _PAGE.code("RC2501")
REFUSED = _PAGE.code("RC2502")
NO_DIALOG = _PAGE.code("RC2503")
OTHER_BASE = _PAGE.code("RC2504")
