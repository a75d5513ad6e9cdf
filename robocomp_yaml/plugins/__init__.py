"""Plug-ins: installed distributions that add to rcyaml by entry points, and the workspaces that name them.

A plug-in is active in the workspaces whose `rcyaml.yaml` names its distribution, and nowhere else: what holds for a
repository is not decided by what else is installed. Where none is named, nobody looks for any.
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


class Plugin(msgspec.Struct, frozen=True, eq=False):
    """A distribution as a workspace names it at `span`. `pieces` are the modules that it adds, by kind and name."""

    name: str
    span: Span
    modules: dict[tuple[str, str], ModuleType]

    @property
    def codes(self) -> dict[str, Code]:
        """Its own diagnostics: the codes that stand in its modules."""
        return {one.id: one for module in self.modules.values() for one in codes_in(module)}

    def call(self, what: str, function: Callable[..., Any], *arguments: Any) -> Any:
        """What a function of the plug-in answers."""
        with self.guarded(what):
            return function(*arguments)

    @contextmanager
    def guarded(self, what: str, passing: type[Exception] = Refused) -> Iterator[None]:
        """Whatever goes wrong in a plug-in is told as its fault: `what` names the part. Exceptions that are answers,
        `passing` among them, go on."""
        try:
            yield
        except (Faulty, Refused, passing):
            raise
        except Exception as error:
            hint = f"in {_place_of(error)}: tell its authors, or take it out of `plugins:`"
            raise Faulty(
                [codes.PLUGIN_FAILED.at(self.span, name=self.name, what=what, reason=reason_of(error), hint=hint)]
            ) from error


class Plugins(msgspec.Struct, frozen=True, eq=False):
    """Those of a workspace, by what is asked of them. `named` are all that it names; `whole` says whether all of
    them could be had, `broken` whether one that is installed could not."""

    active: tuple[Plugin, ...] = ()
    named: tuple[str, ...] = ()
    whole: bool = True
    broken: bool = False

    def of(self, kind: str) -> dict[str, tuple[Plugin, ModuleType]]:
        """What they add of a kind, by name, each with whose it is."""
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
    """An exception in a line."""
    first = str(error).strip().partition("\n")[0]
    return f"{type(error).__name__}: {first}" if first else type(error).__name__


def _place_of(error: BaseException) -> str:
    """Where it was raised: the file as a plug-in's author knows it, and the line."""
    import traceback

    last = traceback.extract_tb(error.__traceback__)[-1]
    return f"{last.filename}:{last.lineno}"
