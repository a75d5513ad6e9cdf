"""RC62xx: the user's files of a component, which a compile never overwrites, and a merge updates."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("specific")

MISSING_METHODS = _PAGE.code("RC6201")
OUTDATED = _PAGE.code("RC6202")
OBSOLETE = _PAGE.code("RC6203")
CONFLICT = _PAGE.code("RC6204")
NO_CLASS = _PAGE.code("RC6205")
OLDER_LANGUAGE = _PAGE.code("RC6207")
MISSING_PROPERTIES = _PAGE.code("RC6206")
NO_BASE = _PAGE.code("RC6208")
REMOVED_PROPERTY = _PAGE.code("RC6209")
