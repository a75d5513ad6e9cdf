"""RC9xxx: values that are sent to components, or returned to them."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("calls")

WRONG_VALUE = _PAGE.code("RC9001")
UNKNOWN_INTERFACE = _PAGE.code("RC9002")
UNKNOWN_METHOD = _PAGE.code("RC9003")
UNKNOWN_EXCEPTION = _PAGE.code("RC9004")
AMBIGUOUS_INTERFACE = _PAGE.code("RC9005")
NOT_ITS_KIND = _PAGE.code("RC9006")
