"""RC33xx: values of parameters, their layers, and what Ice properties can express."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("values")

UNKNOWN_PARAMETER = _PAGE.code("RC3301")
WRONG_TYPE = _PAGE.code("RC3302")
OUT_OF_RANGE = _PAGE.code("RC3303")
NO_MATCH = _PAGE.code("RC3304")
WRONG_SIZE = _PAGE.code("RC3305")
NOT_UNIQUE = _PAGE.code("RC3306")
MISSING = _PAGE.code("RC3307")
CONSTRAINT = _PAGE.code("RC3308")
BAD_REFERENCE = _PAGE.code("RC3309")
NOT_FOR_ICE = _PAGE.code("RC3310")
OPEN_SECRET = _PAGE.code("RC3311")
CHANGED_FLAT = _PAGE.code("RC3330")
OWN_PORT_OF_INSTANCES = _PAGE.code("RC3331")
NO_LAYER = _PAGE.code("RC3321")
LAYER_CYCLE = _PAGE.code("RC3322")
NO_COMPONENT = _PAGE.code("RC3323")
UNKNOWN_PORT = _PAGE.code("RC3324")
OTHER_COMPONENT = _PAGE.code("RC3325")
MISNAMED = _PAGE.code("RC3332")
UNKNOWN_OF_ICE = _PAGE.code("RC3333")
WRONG_FOR_ICE = _PAGE.code("RC3334")
NOT_A_PROPERTY = _PAGE.code("RC3335")
REPEATED_PROPERTY = _PAGE.code("RC3336")
OTHER_IDENTITY = _PAGE.code("RC3337")
IMPOSSIBLE_PROXY = _PAGE.code("RC3338")
IMPOSSIBLE_ENDPOINT = _PAGE.code("RC3339")
MOVED = _PAGE.code("RC3340")
