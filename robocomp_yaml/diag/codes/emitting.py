"""RC60xx, RC61xx: emitting. Why a file or document is not written, and what to know about a file that was."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("emitting")

APART = "give each component a folder of its own, and each interface document a name of its own"
USERS_PLACES = "what is yours belongs in src/ and etc/"

NOT_OURS = _PAGE.code("RC6001")
OUTSIDE = _PAGE.code("RC6002")
CONTESTED = _PAGE.code("RC6003")
EDITED = _PAGE.code("RC6004")
CANNOT_WRITE = _PAGE.code("RC6005")
BAD_MANIFEST = _PAGE.code("RC6006")
INTERRUPTED = _PAGE.code("RC6007")
PORT_CLASH = _PAGE.code("RC6008")
CHANGED = _PAGE.code("RC6010")
UNRESOLVED = _PAGE.code("RC6101")
