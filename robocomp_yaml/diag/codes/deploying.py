"""RC7xxx: deploying. Why a network does not start, and what to know about a running one.

The codes up to RC7019, and those from RC7040, are for all engines and for the local one, those from RC7030 for
`rcyaml run`.
"""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("deploying")

PORT_TAKEN = _PAGE.code("RC7001")
CANNOT = _PAGE.code("RC7002")
NOT_READY = _PAGE.code("RC7003")
ENDED_EARLY = _PAGE.code("RC7004")
FOLDER = _PAGE.code("RC7005")
UNSET_VARIABLE = _PAGE.code("RC7006")
NOT_SUPERVISED = _PAGE.code("RC7007")
OTHER_MACHINE = _PAGE.code("RC7008")
GIVEN_UP = _PAGE.code("RC7009")
EXPIRED = _PAGE.code("RC7011")
OUTDATED = _PAGE.code("RC7012")
STALE = _PAGE.code("RC7016")
NO_ANSWER = _PAGE.code("RC7010")
UNSTABLE = _PAGE.code("RC7040")
DISABLED = _PAGE.code("RC7043")
NOT_ALIVE = _PAGE.code("RC7042")
TOO_SLOW = _PAGE.code("RC7041")
NOBODY_TO_ASK = _PAGE.code("RC7050")
NO_INTERFACE = _PAGE.code("RC7051")
NO_PUSH = _PAGE.code("RC7072")
NO_UNIT = _PAGE.code("RC7081")
LIMIT_DENIED = _PAGE.code("RC7085")
LIMIT_IGNORED = _PAGE.code("RC7086")
NO_REGISTRY = _PAGE.code("RC7020")
NO_NODE = _PAGE.code("RC7021")
NOBODY_SERVES = _PAGE.code("RC7030")
