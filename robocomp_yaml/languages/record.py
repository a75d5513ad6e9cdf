"""What there is to know of a language: one record a language, which every other place asks."""

from __future__ import annotations

import importlib
import os
from collections.abc import Mapping
from types import MappingProxyType, ModuleType

import msgspec

from robocomp_yaml import resources

IMPLEMENTS, REQUIRES, PUBLISHES, SUBSCRIBES = "implements", "requires", "publishes", "subscribes"
PARAMETERS, PERIOD = "parameters", "period"
STATEMACHINE, GUI, COMPATIBILITY, STANDARD = "statemachine", "gui", "compatibility", "standard"
SOURCES, CLASSES, CMAKE, PKG_CONFIG, LINK, PIP = "sources", "classes", "cmake", "pkg-config", "link", "pip"
MERGING = "merging"

PORTS = (IMPLEMENTS, REQUIRES, PUBLISHES, SUBSCRIBES)
USES = (SOURCES, CLASSES, CMAKE, PKG_CONFIG, LINK, PIP)
CAPABILITIES = (*PORTS, PARAMETERS, PERIOD, STATEMACHINE, GUI, COMPATIBILITY, STANDARD, *USES, MERGING)
"""What a language may have or not, called as the keys of the documents where there is one."""


class TargetLanguage(msgspec.Struct, frozen=True, kw_only=True, eq=False):
    """A language that components are written in.

    `name` is what documents say, `title` what is said of it. `package` holds its parts, modules that are imported when
    they are asked for: `plan` always; `code` where it has MERGING; `uses` for libraries; `building` where it
    `has_building`, for builds that are more than the commands of `build`; `checks` for names that it
    cannot have, where it `has_checks`: they are run where a component is in the language, or always if it
    `warns_others` (then with `has_taken(module)`, for documents that are migrated). Its templates stand there too, in
    `templates/`.

    `has` are its capabilities. `ignored` are keys that a document may say all the same, to no effect, since nothing is
    built there. `datamodels` are those of state machines, the usual one first.

    `keywords` are the language's own words; `taken` are names that nothing of the user's can have there, `members` more
    that a parameter cannot have in code.

    `runtime` are the folders that are its run time: the same for all of its components, copied as they stand, and
    shared by those of a workspace; of its templates, or packages of the compiler where they are named with a dot. Where
    it has some, `plan` is told where they are, and `needs(component)` which files one needs that stands alone.
    `runtime_root` is where they stand below the workspace's folder for the language.

    `states` is the generated file that says which Slice the component was made for, where it may share that.

    `program` is what is started, relative to the component's folder, with {name} for the component's. `build` are the
    commands that make it, with {folder} for that folder; none where `compile` writes it. `loaded` are the files that
    the program reads when it starts: folders, and how the names of the files there end; `made_of` are those that it is
    built from, in the same way. `suffixes` are those of code,
    which `code` reads where it has MERGING, and `comment` is how a line of comment begins there.
    """

    name: str
    title: str
    package: str
    description: str
    has: frozenset[str]
    ignored: frozenset[str] = frozenset()
    datamodels: tuple[str, ...] = ()
    standards: tuple[int, ...] = ()
    keywords: frozenset[str] = frozenset()
    taken: frozenset[str] = frozenset()
    members: frozenset[str] = frozenset()
    runtime: tuple[str, ...] = ()
    runtime_root: str = ""
    states: str = ""
    program: str = "bin/{name}"
    build: tuple[tuple[str, ...], ...] = ()
    loaded: Mapping[str, tuple[str, ...]] = MappingProxyType({})
    made_of: Mapping[str, tuple[str, ...]] = MappingProxyType({"generated": (), "src": (), "slice": (".ice",)})
    suffixes: tuple[str, ...] = ()
    comment: str = "//"
    has_building: bool = False
    has_checks: bool = False
    warns_others: bool = False

    def part(self, name: str) -> ModuleType:
        """The module of the language that is called so."""
        return importlib.import_module(f"{self.package}.{name}")

    @property
    def templates(self) -> str:
        """The folder of its templates, and of files that are copied as they stand."""
        file = importlib.import_module(self.package).__file__
        assert file is not None
        return os.path.join(os.path.dirname(file), "templates")

    def text(self, path: str) -> str:
        """The text of a file of its templates."""
        return resources.read(os.path.join(self.templates, path))

    def in_code(self, name: str) -> str:
        """A parameter's name as code spells it: what is reserved gets an underscore."""
        is_reserved = name in self.keywords or name in self.taken or name in self.members
        return f"{name}_" if is_reserved else name
