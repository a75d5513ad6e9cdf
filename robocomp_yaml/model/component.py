"""The CDSL model: components."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robocomp_yaml import languages
from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.interface import Import
from robocomp_yaml.model.located import Spanned, Text

if TYPE_CHECKING:
    from robocomp_yaml.languages.record import TargetLanguage
    from robocomp_yaml.model.statemachine import StateMachine

LISTS = ("implements", "requires", "publishes", "subscribes")
WAIT, FAIL, IGNORE = "wait", "fail", "ignore"


class Use(Spanned, frozen=True):
    """An entry of `implements`, `requires`, `publishes` or `subscribes`.

    `interface` is as written: `Camera`, or `RoboCompCamera.Camera` / `Camera.Camera`. `name` is the interface's name,
    or the entry's own (`{Camera1: Camera}`). `absent` says what a required proxy does while its server is not running.
    `timeout` is in seconds: the longest wait for the server (None: no limit), and the longest call (None: Ice's
    default). `name_span` is the location of the entry's own name, if it has one.
    """

    name: str
    interface: str
    absent: str = WAIT
    timeout: float | None = None
    doc: str = ""
    name_span: Span = Span("")


class Language(Spanned, frozen=True):
    """`name` is that of a record of languages; `standard` is C++'s (17, 20, …) or None."""

    name: str
    standard: int | None = None
    standard_span: Span = Span("")

    @property
    def target(self) -> TargetLanguage:
        """The record of the language."""
        return languages.language(self.name)


class Gui(Spanned, frozen=True):
    toolkit: str
    base: str


CMAKE, PKG_CONFIG, LINK, PIP = "cmake", "pkg-config", "link", "pip"


class Library(Spanned, frozen=True):
    """A library that the user's code needs. `kind` is CMAKE, PKG_CONFIG, LINK or PIP; `version` is as written, '' for
    any; `entry` is the index of the entry in `libraries:`."""

    kind: str
    name: str
    version: str = ""
    entry: int = 0
    version_span: Span = Span("")


class Source(Spanned, frozen=True):
    """A file of the user's repository, or (`is_class`) a folder of shared classes, as a relative path."""

    path: str
    is_class: bool = False

    @property
    def kind(self) -> str:
        """The key of `uses:` that lists the source."""
        return "classes" if self.is_class else "sources"


class Component(Spanned, frozen=True):
    """One CDSL document. `period` is in milliseconds. `parameters` and `statemachine` are paths as written, or '';
    `machine` is a state machine inside the document. `keys_span` has each key with a value that is not empty, and the
    key's span."""

    name: str
    path: str
    language: Language
    imports: tuple[Import, ...] = ()
    implements: tuple[Use, ...] = ()
    requires: tuple[Use, ...] = ()
    publishes: tuple[Use, ...] = ()
    subscribes: tuple[Use, ...] = ()
    parameters: str = ""
    period: int | None = None
    statemachine: str = ""
    machine: StateMachine | None = None
    gui: Gui | None = None
    options: tuple[Text, ...] = ()
    compatibility: str = ""
    sources: tuple[Source, ...] = ()
    libraries: tuple[Library, ...] = ()
    doc: str = ""
    machine_span: Span = Span("")
    parameters_span: Span = Span("")
    keys_span: tuple[tuple[str, Span], ...] = ()
