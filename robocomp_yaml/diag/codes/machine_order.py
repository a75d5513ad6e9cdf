"""RC2238–RC2241: what of a state machine stands behind something that is always taken first, or stands there twice."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("machines")

DEAD_TRANSITION = _PAGE.code("RC2238")
EVENT_TWICE = _PAGE.code("RC2239")
HISTORY_TWICE = _PAGE.code("RC2240")
HISTORY_WAITS = _PAGE.code("RC2241")
