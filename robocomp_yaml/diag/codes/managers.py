"""RC5xxx: what `rcyaml migrate` reports about RCManager's networks and launchers."""

from __future__ import annotations

from robocomp_yaml.diag.code import Family

_PAGE = Family("migration")

DANGLING = _PAGE.code("RC5033")
NOT_STARTED = _PAGE.code("RC5034")
ODD_ENDPOINT = _PAGE.code("RC5035")
NEEDS_SHELL = _PAGE.code("RC5036")
SAME_PROCESS = _PAGE.code("RC5037")
NO_PROGRAM = _PAGE.code("RC5038")
