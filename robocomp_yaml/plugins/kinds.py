"""What plug-ins can add: one row a kind."""

from __future__ import annotations

import importlib
import re
from collections.abc import Collection
from types import ModuleType

import msgspec

from robocomp_yaml.languages.record import TargetLanguage
from robocomp_yaml.plugins import CHECKS, EXPORTS, FORMATS, GRAPHS, LANGUAGES

_NAME = re.compile(r"[a-z][a-z0-9_-]*")
KINDS_OF_CHECKS = ("idsl", "cdsl", "machine", "pdsl", "ddsl")


class Kind(msgspec.Struct, frozen=True):
    """`group` is that of entry points, `called` what one of them is, `needs` what its module has. `home` is the module
    whose `built_in()` names what rcyaml itself has, none of which can be replaced, `taken` other names that are gone.
    """

    name: str
    called: str
    needs: tuple[str, ...]
    home: str = ""
    taken: tuple[str, ...] = ()

    @property
    def group(self) -> str:
        return f"rcyaml.{self.name}"

    def built_in(self) -> Collection[str]:
        own = importlib.import_module(f"robocomp_yaml.{self.home}").built_in() if self.home else ()
        return {*own, *self.taken}

    def problem(self, name: str, module: object) -> str:
        """What is wrong with a module that a plug-in adds, '' if nothing."""
        if not isinstance(module, ModuleType):
            return "its entry point does not name a module"
        if self.home and not _NAME.fullmatch(name):
            return "its name has other characters than lower-case letters, digits, _ and -"
        if lacking := [attribute for attribute in self.needs if not hasattr(module, attribute)]:
            return f"{module.__name__} has no {' and no '.join(lacking)}"
        return self._odd(name, module)

    def _odd(self, name: str, module: ModuleType) -> str:
        if uncalled := [one for one in self.needs if one.islower() and not callable(getattr(module, one))]:
            return f"{uncalled[0]} is no function"
        if self.name == LANGUAGES:
            record = module.LANGUAGE
            if not isinstance(record, TargetLanguage):
                return "LANGUAGE is no TargetLanguage"
            if record.name != name:
                return f"LANGUAGE is called '{record.name}'"
        if self.name == CHECKS and module.KIND not in KINDS_OF_CHECKS:
            return f"KIND is {module.KIND!r}, and is to be one of {', '.join(KINDS_OF_CHECKS)}"
        return ""


KINDS = (
    Kind(LANGUAGES, "language", ("LANGUAGE",), "languages", ("slice", "config", "docs")),
    Kind(EXPORTS, "export", ("export",), "emit.exports"),
    Kind(CHECKS, "check", ("KIND", "check")),
    Kind(FORMATS, "legacy format", ("RULES", "convert"), "legacy.rules"),
    Kind(GRAPHS, "picture", ("draw",), "emit.graphs.forms"),
)
BY_GROUP = {kind.group: kind for kind in KINDS}
