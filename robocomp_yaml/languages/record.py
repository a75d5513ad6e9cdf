"""The record of a language: all that other packages need to know of it."""

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
"""What a language may support. Where documents have a key for it, the capability has the name of the key."""


class TargetLanguage(msgspec.Struct, frozen=True, kw_only=True, eq=False):
    """A language that components are written in.

    `name` is the name in documents, `title` the name in messages. `package` holds the language's parts: modules that
    are imported when they are needed, and `templates/`. `plan` always exists; `code` if the language has MERGING;
    `uses` if it has libraries or sources; `usage` if it `has_usage`, for checks of the user's code; `checker` if it
    `has_checker`, for `check --code`; `building` if it `has_building`, for builds that are more than the commands of
    `build`; `checks` if it `has_checks`, for names that are illegal in the language. The checks run if a component
    is in the language; if it `warns_others`, they always run, and `checks.has_taken(module)` is called for migrated
    documents. If it `has_tls`, its run time needs only Ice's properties to talk over TLS.

    `has` are the capabilities. `ignored` are keys that documents may have without effect, because nothing is built.
    `datamodels` are the data models of state machines, the default first.

    `keywords` are the keywords of the language, `taken` other names that no document may use in code, `members` names
    that a parameter cannot have in code.

    `runtime` are the folders of the run time: in `templates/`, or packages of the compiler (names with a dot). They
    are copied unchanged, and shared by the components of a workspace, below `runtime_root` in the workspace's folder
    for the language. With a run time, `plan` is called with a `Layout` too, and `needs(component)` decides which files
    of the run time a component outside of a workspace needs.

    `states` is the generated file that names the Slice for which the component was generated, if it shares the Slice.

    `program` is what is started, relative to the component's folder; {name} is the component's name. `build` are the
    commands that build it; {folder} is the component's folder. `build` is empty if `compile` writes the program.
    `loaded` are the files that the program reads when it starts, `made_of` the files that it is built from: folders,
    and the endings of the file names in them. `suffixes` are those of source files, which `code` parses; `comment`
    begins a comment.
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
    has_usage: bool = False
    has_checker: bool = False
    has_building: bool = False
    has_checks: bool = False
    warns_others: bool = False
    has_tls: bool = False

    def part(self, name: str) -> ModuleType:
        """The part of the language in the module `name`."""
        return importlib.import_module(f"{self.package}.{name}")

    @property
    def templates(self) -> str:
        """The folder of the templates, and of files that are copied unchanged."""
        file = importlib.import_module(self.package).__file__
        assert file is not None
        return os.path.join(os.path.dirname(file), "templates")

    def text(self, path: str) -> str:
        """The text of a file in `templates`."""
        return resources.read(os.path.join(self.templates, path))

    def in_code(self, name: str) -> str:
        """The name of a parameter in code: a reserved name gets an underscore."""
        is_reserved = name in self.keywords or name in self.taken or name in self.members
        return f"{name}_" if is_reserved else name
