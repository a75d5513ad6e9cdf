"""RC0xxx: files, YAML's syntax, and the shape of documents."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("files")

UNREADABLE = _PAGE.code("RC0001")
NOT_UTF8 = _PAGE.code("RC0002")
BINARY = _PAGE.code("RC0003")
TOO_LARGE = _PAGE.code("RC0004")
UNKNOWN_KIND = _PAGE.code("RC0005")
NOTHING_FOUND = _PAGE.code("RC0006")
SYNTAX = _PAGE.code("RC0101")
EMPTY = _PAGE.code("RC0102")
DUPLICATE_KEY = _PAGE.code("RC0103")
SEVERAL_DOCUMENTS = _PAGE.code("RC0104")
ALIASES = _PAGE.code("RC0105")
TOO_DEEP = _PAGE.code("RC0106")
LEADING_ZEROS = _PAGE.code("RC0107")
KEY_COLON = _PAGE.code("RC0108")
TAG = _PAGE.code("RC0109")
KEY_TYPE = _PAGE.code("RC0110")
NOT_A_MAPPING = _PAGE.code("RC0201")
UNKNOWN_KEY = _PAGE.code("RC0202")
MISSING_KEY = _PAGE.code("RC0203")
WRONG_SHAPE = _PAGE.code("RC0204")
WRONG_NAME = _PAGE.code("RC0205")
NO_KIND = _PAGE.code("RC0206")
TWO_KINDS = _PAGE.code("RC0207")
IMPOSSIBLE = _PAGE.code("RC0209")
NAME_TOO_LONG = _PAGE.code("RC0210")
BAD_ICE_TEXT = _PAGE.code("RC0208")
WORKSPACE_SETTING = _PAGE.code("RC0301")
