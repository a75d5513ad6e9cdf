"""The CDSL model: what a component is made of."""

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
    or the entry's own (`{Camera1: Camera}`). `absent` says what a required proxy does when the other side is not
    there; `timeout` is in seconds: how long to wait for it (None: for ever), and for each call thereafter (None: Ice's
    default).
    """

    name: str
    interface: str
    absent: str = WAIT
    timeout: float | None = None
    doc: str = ""


class Language(Spanned, frozen=True):
    """`name` is that of a record of languages; `standard` is C++'s (17, 20, …) or None."""

    name: str
    standard: int | None = None
    standard_span: Span = Span("")

    @property
    def target(self) -> TargetLanguage:
        """All that there is to know of the language."""
        return languages.language(self.name)


class Gui(Spanned, frozen=True):
    toolkit: str
    base: str


CMAKE, PKG_CONFIG, LINK, PIP = "cmake", "pkg-config", "link", "pip"


class Library(Spanned, frozen=True):
    """A library that the component's own code needs. `kind` is CMAKE, PKG_CONFIG, LINK or PIP; `version` is as
    written, '' for any; `entry` counts the entries of the document."""

    kind: str
    name: str
    version: str = ""
    entry: int = 0
    version_span: Span = Span("")


class Source(Spanned, frozen=True):
    """A file of the user's repository, or (`is_class`) a folder of shared classes; by a relative path."""

    path: str
    is_class: bool = False

    @property
    def kind(self) -> str:
        """The key of `uses:` that it stands below."""
        return "classes" if self.is_class else "sources"


class Component(Spanned, frozen=True):
    """One CDSL document. `period` is in milliseconds. `parameters` and `statemachine` are paths as written,
    or ''; `machine` is the state machine that stands in the document. `keys_span` are the keys of the document that
    say anything, and where they stand."""

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
