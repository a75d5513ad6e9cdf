"""RC31xx, RC32xx: parameters, and references between documents of parameters, components and values."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("pdsl")

NO_TYPE = _PAGE.code("RC3101")
TWO_TYPES = _PAGE.code("RC3102")
UNKNOWN_TYPE = _PAGE.code("RC3103")
RECURSIVE_TYPE = _PAGE.code("RC3104")
TOO_LARGE = _PAGE.code("RC3105")
BASIC_NAME = _PAGE.code("RC3106")
UNUSED_TYPE = _PAGE.code("RC3107")
LIMIT_MISFIT = _PAGE.code("RC3108")
EMPTY_LIMIT = _PAGE.code("RC3109")
UNREACHABLE = _PAGE.code("RC3110")
BAD_PATTERN = _PAGE.code("RC3111")
DEFAULT_AND_OPTIONAL = _PAGE.code("RC3112")
BAD_DEFAULT = _PAGE.code("RC3113")
NO_IDENTIFIER = _PAGE.code("RC3114")
CODE_CLASH = _PAGE.code("RC3115")
PROPERTY_CLASH = _PAGE.code("RC3116")
PROPERTY_PREFIX = _PAGE.code("RC3117")
PERIOD = _PAGE.code("RC3118")
BAD_EXPRESSION = _PAGE.code("RC3119")
DEFAULTS_BREAK = _PAGE.code("RC3120")
BAD_SPELLING = _PAGE.code("RC3121")
SECRET_DEFAULT = _PAGE.code("RC3125")
SECRET_MISFIT = _PAGE.code("RC3126")
NO_COMPONENT = _PAGE.code("RC3201")
NO_PARAMETERS = _PAGE.code("RC3202")
DISAGREEMENT = _PAGE.code("RC3203")
NAMED = _PAGE.code("RC3204")
NOT_BESIDE = _PAGE.code("RC3205")
UNCLAIMED = _PAGE.code("RC3206")
MISPLACED = _PAGE.code("RC3207")
