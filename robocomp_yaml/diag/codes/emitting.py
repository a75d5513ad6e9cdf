"""RC60xx: errors and warnings about written files."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("emitting")

APART = "put each component in its own folder, and give each interface document a unique name"
USERS_FOLDERS = "write your code in src/, and your settings in etc/"

NOT_GENERATED = _PAGE.code("RC6001")
OUTSIDE = _PAGE.code("RC6002")
CONTESTED = _PAGE.code("RC6003")
EDITED = _PAGE.code("RC6004")
CANNOT_WRITE = _PAGE.code("RC6005")
BAD_MANIFEST = _PAGE.code("RC6006")
INTERRUPTED = _PAGE.code("RC6007")
PORT_CLASH = _PAGE.code("RC6008")
LODGED = _PAGE.code("RC6009")
CHANGED_CONFIG = _PAGE.code("RC6010")
RANGE_FULL = _PAGE.code("RC6011")
RANGE_EMPTY = _PAGE.code("RC6012")
UNRESOLVED = _PAGE.code("RC6101")
