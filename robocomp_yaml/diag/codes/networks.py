"""RC42xx to RC44xx: the network that is derived from a deployment."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("networks")

UNRESOLVED = _PAGE.code("RC4201")
AMBIGUOUS = _PAGE.code("RC4202")
MISMATCH = _PAGE.code("RC4203")
NOT_SERVED = _PAGE.code("RC4204")
NO_TARGET = _PAGE.code("RC4205")
CLOSED_GROUP = _PAGE.code("RC4206")
NOT_ENABLED = _PAGE.code("RC4207")
NO_STORM = _PAGE.code("RC4208")
SEVERAL_STORMS = _PAGE.code("RC4209")
NOT_PUBLISHED = _PAGE.code("RC4210")
TOPIC_MISMATCH = _PAGE.code("RC4211")
BAD_ENDPOINT = _PAGE.code("RC4301")
BAD_PROXY = _PAGE.code("RC4015")
IGNORED_ENDPOINT = _PAGE.code("RC4016")
CHANGED_BY_EXPORT = _PAGE.code("RC4018")
NAME_TOO_LONG = _PAGE.code("RC4109")
PATH_TOO_LONG = _PAGE.code("RC4110")
PORT_TOO_HIGH = _PAGE.code("RC4302")
PORT_CONFLICT = _PAGE.code("RC4303")
LOOPBACK = _PAGE.code("RC4304")
BAD_ADDRESS = _PAGE.code("RC4305")
NOT_RESOLVED = _PAGE.code("RC4306")
NO_ENTRY = _PAGE.code("RC4307")
CYCLE = _PAGE.code("RC4401")
DEADLOCK = _PAGE.code("RC4402")
NOT_BUILT = _PAGE.code("RC4403")
NO_PROGRAM = _PAGE.code("RC4404")
OPEN_CONFIG = _PAGE.code("RC4311")
OPEN_SECRET = _PAGE.code("RC4310")
