"""RC2xxx: components."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("cdsl")

UNRESOLVED_IMPORT = _PAGE.code("RC2101")
IMPORT_CASE = _PAGE.code("RC2102")
DUPLICATE_IMPORT = _PAGE.code("RC2103")
UNKNOWN_INTERFACE = _PAGE.code("RC2003")
AMBIGUOUS_INTERFACE = _PAGE.code("RC2004")
DUPLICATE_PORT = _PAGE.code("RC2005")
ACCESSOR_CLASH = _PAGE.code("RC2006")
PARTLY_PUBLISHED = _PAGE.code("RC2007")
TOPIC_IMPLEMENTED = _PAGE.code("RC2008")
COMMON_BEHAVIOR = _PAGE.code("RC2009")
SAME_FOLDER = _PAGE.code("RC2010")
SAME_NAME = _PAGE.code("RC2011")
