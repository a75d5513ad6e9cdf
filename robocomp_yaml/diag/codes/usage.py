"""RC63xx: the use that the user's code makes of the generated worker, and of its types."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("usage")

UNKNOWN_PROXY = _PAGE.code("RC6301")
UNKNOWN_METHOD = _PAGE.code("RC6302")
UNKNOWN_EVENT = _PAGE.code("RC6303")
WRONG_ARGUMENTS = _PAGE.code("RC6304")
UNKNOWN_ARGUMENT = _PAGE.code("RC6305")
UNKNOWN_PARAMETER = _PAGE.code("RC6306")
NOT_EDITABLE = _PAGE.code("RC6307")
WRONG_VALUE = _PAGE.code("RC6308")
UNKNOWN_SETTING = _PAGE.code("RC6309")
UNKNOWN_OF_MACHINE = _PAGE.code("RC6310")
NO_HANDLER = _PAGE.code("RC6311")
NEVER_CALLED = _PAGE.code("RC6312")
UNKNOWN_MODULE = _PAGE.code("RC6313")
UNKNOWN_TYPE = _PAGE.code("RC6314")
UNKNOWN_ENUMERATOR = _PAGE.code("RC6315")
UNKNOWN_ATTRIBUTE = _PAGE.code("RC6316")
SYNTAX = _PAGE.code("RC6317")
ERROR_OF_CHECKER = _PAGE.code("RC6318")
WARNING_OF_CHECKER = _PAGE.code("RC6319")
NOT_ASSIGNED = _PAGE.code("RC6320")
