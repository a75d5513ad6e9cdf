"""Plug-ins: installed distributions that extend rcyaml by entry points, and the workspaces that name them.

A plug-in is active only in the workspaces whose `rcyaml.yaml` names its distribution, so that the meaning of a
repository does not depend on what else is installed. If no plug-in is named, none is searched for.
"""

from __future__ import annotations

import importlib
import re
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from types import ModuleType
from typing import Any

import msgspec

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.diag.span import Span
from robocomp_yaml.languages.record import TargetLanguage

LANGUAGES, EXPORTS, CHECKS, FORMATS, GRAPHS = "languages", "exports", "checks", "formats", "graphs"
_NAME = re.compile(r"[a-z][a-z0-9_-]*")
KINDS_OF_CHECKS = ("idsl", "cdsl", "machine", "pdsl", "ddsl")


class Kind(msgspec.Struct, frozen=True):
    """A kind of extension. `group` is its group of entry points, `called` its word in messages; `needs` are the
    attributes that a module must have. `home` is the module whose `built_in()` returns the names of rcyaml's own
    extensions, which cannot be replaced; `taken` are other reserved names."""

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
        """What is wrong with a module of a plug-in, or ''."""
        if not isinstance(module, ModuleType):
            return "its entry point does not name a module"
        if self.home and not _NAME.fullmatch(name):
            return "its name has characters other than lower-case letters, digits, _ and -"
        if missing := [attribute for attribute in self.needs if not hasattr(module, attribute)]:
            return f"{module.__name__} has no {' and no '.join(missing)}"
        return self._wrong_attribute(name, module)

    def _wrong_attribute(self, name: str, module: ModuleType) -> str:
        if not_callable := [one for one in self.needs if one.islower() and not callable(getattr(module, one))]:
            return f"{not_callable[0]} is not a function"
        if self.name == LANGUAGES:
            record = module.LANGUAGE
            if not isinstance(record, TargetLanguage):
                return "LANGUAGE is not a TargetLanguage"
            if record.name != name:
                return f"the name of LANGUAGE is '{record.name}'"
        if self.name == CHECKS and module.KIND not in KINDS_OF_CHECKS:
            return f"KIND is {module.KIND!r}, which is not one of {', '.join(KINDS_OF_CHECKS)}"
        return ""


KINDS = (
    Kind(LANGUAGES, "language", ("LANGUAGE",), "languages", ("slice", "config", "docs")),
    Kind(EXPORTS, "export", ("export",), "emit.exports"),
    Kind(CHECKS, "check", ("KIND", "check")),
    Kind(FORMATS, "legacy format", ("RULES", "convert"), "legacy.rules"),
    Kind(GRAPHS, "picture", ("draw",), "emit.graphs.forms"),
)
BY_GROUP = {kind.group: kind for kind in KINDS}


class Plugin(msgspec.Struct, frozen=True, eq=False):
    """A distribution that a workspace names at `span`. `modules` are those that it adds, by kind and name."""

    name: str
    span: Span
    modules: dict[tuple[str, str], ModuleType]

    @property
    def codes(self) -> dict[str, Code]:
        """The codes of its diagnostics, which its modules define."""
        return {one.id: one for module in self.modules.values() for one in codes_in(module)}

    def call(self, what: str, function: Callable[..., Any], *arguments: Any) -> Any:
        """The result of a function of the plug-in. Raises Faulty if the plug-in fails."""
        with self.guarded(what):
            return function(*arguments)

    @contextmanager
    def guarded(self, what: str, passing: type[Exception] = Refused) -> Iterator[None]:
        """Raises Faulty, with a diagnostic about the plug-in, if its code fails; `what` names the part. Faulty, Refused
        and `passing` are results, and are not changed."""
        try:
            yield
        except (Faulty, Refused, passing):
            raise
        except (Exception, SystemExit) as error:
            hint = f"in {_location(error)}: report it to its authors, or remove it from `plugins:`"
            raise Faulty(
                [codes.PLUGIN_FAILED.at(self.span, name=self.name, what=what, reason=reason_of(error), hint=hint)]
            ) from error


class Plugins(msgspec.Struct, frozen=True, eq=False):
    """The plug-ins of a workspace. `named` are all that it names; `whole` says that all of them are active, `broken`
    that an installed one is not."""

    active: tuple[Plugin, ...] = ()
    named: tuple[str, ...] = ()
    whole: bool = True
    broken: bool = False

    def of(self, kind: str) -> dict[str, tuple[Plugin, ModuleType]]:
        """The extensions of a kind, by name, each with its plug-in."""
        return {
            name: (plugin, module) for plugin in self.active
            for (of, name), module in plugin.modules.items() if of == kind
        }  # fmt: skip

    @property
    def languages(self) -> tuple[TargetLanguage, ...]:
        return tuple(module.LANGUAGE for _, module in self.of(LANGUAGES).values())

    @property
    def codes(self) -> dict[str, Code]:
        return {id_: code for plugin in self.active for id_, code in plugin.codes.items()}

    def has(self, plugin: str) -> bool:
        return any(one.name == plugin for one in self.active)


NONE = Plugins()


def codes_in(module: ModuleType) -> list[Code]:
    return [one for one in vars(module).values() if isinstance(one, Code)]


def reason_of(error: BaseException) -> str:
    """An exception as one line."""
    first = str(error).strip().partition("\n")[0]
    return f"{type(error).__name__}: {first}" if first else type(error).__name__


def _location(error: BaseException) -> str:
    """The file and the line that raised an exception."""
    import traceback

    last = traceback.extract_tb(error.__traceback__)[-1]
    return f"{last.filename}:{last.lineno}"
