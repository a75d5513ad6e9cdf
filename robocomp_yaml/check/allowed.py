"""Suppresses diagnostics that comments (`# rcyaml: allow`) allow, and reports comments that suppress nothing."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.codes import row_of
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic
from robocomp_yaml.plugins import Plugins
from robocomp_yaml.source.spelled import DocumentText, DocumentTexts

if TYPE_CHECKING:
    from robocomp_yaml.source.allowances import Allowance

_ABOUT_ALLOWANCES = ("RC0060", "RC0061", "RC0062", "RC0063", "RC0064")


class AllowanceVerdict(msgspec.Struct, frozen=True):
    """`reported` are the diagnostics that no comment suppresses, and those about comments that cannot suppress theirs;
    `used` are the allowances that apply to a diagnostic."""

    reported: tuple[Diagnostic, ...]
    used: frozenset[Allowance]


class Allowances(msgspec.Struct, frozen=True):
    """The allowances of a run's documents by path; `faults` are the diagnostics about the comments themselves."""

    by_file: Mapping[str, tuple[Allowance, ...]] = {}
    faults: tuple[Diagnostic, ...] = ()
    texts: Mapping[str, DocumentText] = {}

    @classmethod
    def of(cls, texts: DocumentTexts, paths: Iterable[str], plugins_of: Callable[[str], Plugins]) -> Allowances:
        """The allowances in the YAML documents at these paths; `plugins_of` returns the plug-ins of a workspace."""
        by_file, faults, with_comments = {}, [], {}
        paths = list(paths)
        if not paths:
            return cls()
        from robocomp_yaml.source.allowances import allowances  # few documents have any

        for path in paths:
            if (text := texts.get(path)) is not None:
                plugins = plugins_of(path)
                found, wrong = allowances(text, plugins.codes, whole=plugins.whole)
                by_file[path], with_comments[path] = tuple(found), text
                faults += wrong
        return cls(by_file, tuple(faults), with_comments)

    def judge(self, diagnostics: Iterable[Diagnostic], lint: Callable[[str], Mapping[str, str]]) -> AllowanceVerdict:
        """Separates suppressed diagnostics from the others. `lint` returns the severities that the workspace of a file
        sets. A comment can suppress all but errors that have no other severity there."""
        reported: list[Diagnostic] = []
        used: set[Allowance] = set()
        errors: set[Allowance] = set()
        for one in diagnostics:
            file = self.by_file.get(one.span.file, ())
            covering = [each for each in file if each.code == one.code and each.covers(one.span)]
            if not covering:
                reported.append(one)
            elif one.code in _ABOUT_ALLOWANCES or ERROR == one.severity == lint(one.span.file).get(one.code, ERROR):
                errors.update(covering)
                reported.append(one)
            else:
                used.add(covering[0])
        return AllowanceVerdict((*reported, *_of_errors(errors)), frozenset(used | errors))

    def unused(
        self, files: Iterable[str], used: Collection[Allowance], *, environment: bool
    ) -> Iterator[Diagnostic]:  # fmt: skip
        """Reports the allowances in these files that are not `used`, after a complete check."""
        for file in files:
            for one in self.by_file.get(file, ()):
                if one not in used and _is_checked(row_of(one.code), environment):
                    yield codes.ALLOW_UNUSED.at(
                        one.span, code=one.code, hint="remove it", fixes=[one.removal(self.texts[file])]
                    )


def commented_in(contents: Mapping[str, bytes]) -> list[str]:
    """The paths of the YAML documents that may have such comments."""
    paths = [path for path, raw in contents.items() if path.endswith(".yaml") and b"rcyaml" in raw.lower()]
    if not paths:
        return []
    from robocomp_yaml.source.allowances import OURS

    return [path for path in paths if OURS.search(contents[path])]


def _of_errors(errors: Iterable[Allowance]) -> Iterator[Diagnostic]:
    """Reports allowances of errors, and of diagnostics about such comments."""
    for one in sorted(errors, key=lambda one: (one.span, one.code)):
        why = "it is about such comments" if one.code in _ABOUT_ALLOWANCES else "it is an error"
        yield codes.ALLOW_ERROR.at(one.span, code=one.code, why=why, hint="correct the error, and remove this comment")


def _is_checked(row: Code, environment: bool) -> bool:
    """Whether a check can report the code: some codes are reported only by `rcyaml compile`."""
    command = row.command
    return not command.startswith("compile") and (environment or "--environment" not in command)
