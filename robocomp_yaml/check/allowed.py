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
from robocomp_yaml.source.spelled import DocumentText, DocumentTexts

_ABOUT_THEM = ("RC0060", "RC0061", "RC0062", "RC0063", "RC0064")


class Judged(msgspec.Struct, frozen=True):
    """`told` is what no comment allows, and what is wrong with comments for that; `used` are the allowances that this
    gave something to do."""

    told: tuple[Diagnostic, ...]
    used: frozenset[Allowance]


class Allowed(msgspec.Struct, frozen=True):
    """The allowances of a run's documents by their paths; `said` is what is wrong with the comments themselves."""

    by_file: Mapping[str, tuple[Allowance, ...]] = {}
    said: tuple[Diagnostic, ...] = ()
    texts: Mapping[str, DocumentText] = {}

    @classmethod
    def of(cls, texts: DocumentTexts, plugins_of: Callable[[str], Plugins]) -> Allowed:
        """Those of the YAML documents among these files; `plugins_of` says which plug-ins count for one."""
        by_file, said, having = {}, [], {}
        for path, raw in texts.contents.items():
            if path.endswith(".yaml") and OURS.search(raw) and (text := texts.get(path)) is not None:
                plugins = plugins_of(path)
                found, wrong = allowances(text, plugins.codes, whole=plugins.whole)
                by_file[path], having[path] = tuple(found), text
                said += wrong
        return cls(by_file, tuple(said), having)

    def judge(self, diagnostics: Iterable[Diagnostic], lint: Callable[[str], Mapping[str, str]]) -> Judged:
        """Which of these are told. `lint` gives the severities that a file's workspace asks for: an error that it makes
        less than an error can be allowed, and so can a warning that it makes an error."""
        told: list[Diagnostic] = []
        used: set[Allowance] = set()
        errors: set[Allowance] = set()
        for one in diagnostics:
            file = self.by_file.get(one.span.file, ())
            here = [each for each in file if each.code == one.code and each.covers(one.span)]
            if not here:
                told.append(one)
            elif one.code in _ABOUT_THEM or ERROR == one.severity == lint(one.span.file).get(one.code, ERROR):
                errors.update(here)
                told.append(one)
            else:
                used.add(here[0])
        return Judged((*told, *_of_errors(errors)), frozenset(used | errors))

    def in_vain(
        self, files: Iterable[str], used: Collection[Allowance], *, environment: bool
    ) -> Iterator[Diagnostic]:  # fmt: skip
        """The allowances in these files that are not among those that a whole check used."""
        for file in files:
            for one in self.by_file.get(file, ()):
                if one not in used and _is_checked(row_of(one.code), environment):
                    yield codes.ALLOW_UNUSED.at(
                        one.span, code=one.code, hint="remove it", fixes=[one.removal(self.texts[file])]
                    )


def _of_errors(errors: Iterable[Allowance]) -> Iterator[Diagnostic]:
    """The allowances of what no comment can allow."""
    for one in sorted(errors, key=lambda one: (one.span, one.code)):
        why = "it is about such comments" if one.code in _ABOUT_THEM else "it is an error"
        yield codes.ALLOW_ERROR.at(one.span, code=one.code, why=why, hint="mend what it says, and remove this")


def _is_checked(row: Code, environment: bool) -> bool:
    """Whether a check would have given it: what only a compile can see, it cannot judge."""
    command = row.command
    return not command.startswith("compile") and (environment or "--environment" not in command)
