"""RC4xxx: deployment documents, and what they refer to."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("ddsl")

DUPLICATE_NAME = _PAGE.code("RC4001")
UNKNOWN_HOST = _PAGE.code("RC4002")
NO_HOST = _PAGE.code("RC4003")
HOST_DIFFERS = _PAGE.code("RC4004")
UNKNOWN_NAME = _PAGE.code("RC4005")
NOT_A_PROCESS = _PAGE.code("RC4006")
UNKNOWN_PORT = _PAGE.code("RC4007")
NO_INDEX = _PAGE.code("RC4008")
STRAY_INDEX = _PAGE.code("RC4009")
NOT_SERVED = _PAGE.code("RC4010")
SEVERAL_SERVE = _PAGE.code("RC4011")
UNKNOWN_METHOD = _PAGE.code("RC4012")
GROUP_CYCLE = _PAGE.code("RC4013")
BAD_PATTERN = _PAGE.code("RC4014")
CONFIG_AS_PROGRAM = _PAGE.code("RC4017")
NO_COMPONENT = _PAGE.code("RC4101")
SEVERAL_COMPONENTS = _PAGE.code("RC4102")
NO_CONFIG = _PAGE.code("RC4103")
OTHER_VALUES = _PAGE.code("RC4104")
NO_INCLUDE = _PAGE.code("RC4105")
INCLUDE_CYCLE = _PAGE.code("RC4106")
INCLUDED_TWICE = _PAGE.code("RC4107")
TOO_LARGE = _PAGE.code("RC4108")
TWO_USERS = _PAGE.code("RC4120")
HOST_KEY_DIFFERS = _PAGE.code("RC4121")
