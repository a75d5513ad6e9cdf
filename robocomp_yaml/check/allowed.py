"""What comments in documents allow is not told; what they allow in vain is."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping

import msgspec

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.codes import row_of
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic
from robocomp_yaml.plugins import Plugins
from robocomp_yaml.source.allowances import OURS, Allowance, allowances
from robocomp_yaml.source.spelled import Text, text_of

_ABOUT_THEM = ("RC0060", "RC0061", "RC0062", "RC0063", "RC0064")


class Allowed(msgspec.Struct):
    """The allowances of a run's documents by their paths. `said` is what is wrong with the comments themselves; `used`
    are those that allowed something, `errors` those that something was told at that cannot be allowed."""

    by_file: dict[str, list[Allowance]] = {}
    said: list[Diagnostic] = []
    texts: dict[str, Text] = {}
    used: set[Allowance] = set()
    errors: set[Allowance] = set()

    @classmethod
    def of(cls, contents: Mapping[str, bytes], plugins_of: Callable[[str], Plugins]) -> Allowed:
        """Those of the YAML documents among these files; `plugins_of` says which plug-ins count for one."""
        made = cls()
        for path, raw in contents.items():
            if path.endswith(".yaml") and OURS.search(raw) and (text := text_of(path, raw)) is not None:
                plugins = plugins_of(path)
                made.by_file[path], said = allowances(text, plugins.codes, whole=plugins.whole)
                made.texts[path] = text
                made.said += said
        return made

    def told(
        self, diagnostics: Iterable[Diagnostic], lint: Callable[[str], Mapping[str, str]]
    ) -> Iterator[Diagnostic]:  # fmt: skip
        """What no comment allows. `lint` gives the severities that a file's workspace asks for: an error that it makes
        less than an error can be allowed, and so can a warning that it makes an error."""
        for one in diagnostics:
            file = self.by_file.get(one.span.file, ())
            here = [each for each in file if each.code == one.code and each.covers(one.span)]
            if not here:
                yield one
            elif one.code in _ABOUT_THEM or ERROR == one.severity == lint(one.span.file).get(one.code, ERROR):
                self.errors.update(here)
                yield one
            else:
                self.used.add(here[0])

    def in_vain(self, files: Collection[str], *, environment: bool) -> Iterator[Diagnostic]:
        """The allowances in these files that a whole check found no use for."""
        for file in files:
            for one in self.by_file.get(file, ()):
                if one not in self.used and one not in self.errors and _is_checked(row_of(one.code), environment):
                    yield codes.ALLOW_UNUSED.at(
                        one.span, code=one.code, hint="remove it", fixes=[one.removal(self.texts[file])]
                    )

    def of_errors(self) -> Iterator[Diagnostic]:
        """The allowances of what no comment can allow."""
        for one in sorted(self.errors, key=lambda one: (one.span, one.code)):
            why = "it is about such comments" if one.code in _ABOUT_THEM else "it is an error"
            yield codes.ALLOW_ERROR.at(one.span, code=one.code, why=why, hint="mend what it says, and remove this")


def _is_checked(row: Code, environment: bool) -> bool:
    """Whether a check would have given it: what only a compile can see, it cannot judge."""
    command = row.command
    return not command.startswith("compile") and (environment or "--environment" not in command)
