"""The plug-ins that a workspace names: resolved among the installed distributions, loaded, and identified by their
builds."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from importlib import metadata
from importlib.util import find_spec
from types import ModuleType

from robocomp_yaml import languages
from robocomp_yaml.diag.codes import files as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import Hint
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import meaning, suggest
from robocomp_yaml.plugins import BY_GROUP, LANGUAGES, Kind, Plugin, Plugins, codes_in, reason_of
from robocomp_yaml.source.digest import digest, states

_OWN_CODE = re.compile(r"RC\d")
_CODE = re.compile(r"[A-Z]{2,}\d{3,4}")


def resolve(named: Iterable[tuple[str, Span]]) -> tuple[Plugins, list[Diagnostic]]:
    """The plug-ins of these names, each with the location of its name, and their diagnostics."""
    names = list(named)
    diagnostics: list[Diagnostic] = []
    active: list[Plugin] = []
    seen: set[str] = set()
    for name, span in names:
        if normalized(name) in seen:
            continue
        seen.add(normalized(name))
        distribution = _distribution(name)
        if distribution is None:
            diagnostics.append(codes.NO_PLUGIN.at(span, name=name, hint=_missing(name)))
            continue
        entries = _entries(distribution)
        if not entries:
            hint = _did_you_mean(name) or "remove it from `plugins:`"
            diagnostics.append(codes.NOT_A_PLUGIN.at(span, name=name, hint=hint))
            continue
        plugin = Plugin(normalized(name), span, {})
        for entry in entries:
            diagnostics += _load_entry(plugin, entry, active)
        active.append(plugin)
    are_broken = any(one.code in (codes.PLUGIN_BROKEN.id, codes.PLUGIN_CLASH.id) for one in diagnostics)
    plugins = Plugins(tuple(active), tuple(normalized(name) for name, _ in names), not diagnostics, are_broken)
    return plugins, diagnostics


def load(names: Iterable[str]) -> None:
    """Loads plug-ins for the codes of their diagnostics, which an earlier run reported."""
    resolve((name, Span("")) for name in names)


def normalized(name: str) -> str:
    """The name of a distribution in the form in which installers compare it (PEP 503)."""
    return re.sub(r"[-_.]+", "-", name).lower()


def identity(name: str) -> str:
    """A digest that changes with each build of a plug-in, from the record of its installer, and the sizes and times of
    its modules, which change in a checkout; '' if it is not installed."""
    distribution = _distribution(name)
    if distribution is None:
        return ""
    parts = [distribution.version, distribution.read_text("RECORD") or "", *_lines(distribution)]
    for package in sorted({entry.module.partition(".")[0] for entry in _entries(distribution)}):
        parts += _files(package)
    return digest("\n".join(parts).encode(errors="surrogateescape"))


def _distribution(name: str) -> metadata.Distribution | None:
    try:
        return metadata.distribution(name)
    except (metadata.PackageNotFoundError, ValueError):
        return None


def _entries(distribution: metadata.Distribution) -> list[metadata.EntryPoint]:
    return [entry for entry in distribution.entry_points if entry.group in BY_GROUP]


def _lines(distribution: metadata.Distribution) -> list[str]:
    return [f"{entry.group} {entry.name} {entry.value}" for entry in _entries(distribution)]


def _files(package: str) -> Iterator[str]:
    try:
        spec = find_spec(package)
    except (ImportError, ValueError):
        return
    if spec is None:
        return
    for folder in spec.submodule_search_locations or ():
        if os.path.isdir(folder):
            yield from states(folder, len(folder))
    if spec.origin and os.path.isfile(spec.origin):
        status = os.stat(spec.origin)
        yield f"{spec.origin} {status.st_size} {status.st_mtime_ns} {status.st_ctime_ns}"


def _load_entry(plugin: Plugin, entry: metadata.EntryPoint, others: list[Plugin]) -> Iterator[Diagnostic]:
    """Adds the module of an entry point to the plug-in, or reports why that is not possible."""
    kind = BY_GROUP[entry.group]
    what = f"{kind.called} '{entry.name}'"
    try:
        module = entry.load()
    except (Exception, SystemExit) as error:  # noqa: BLE001  # an imported module may do anything
        hint = _why_not(error, plugin.name)
        yield codes.PLUGIN_BROKEN.at(plugin.span, name=plugin.name, what=what, reason=reason_of(error), hint=hint)
        return
    if problem := kind.problem(entry.name, module) or _problem_of_codes(module):
        yield codes.PLUGIN_BROKEN.at(plugin.span, name=plugin.name, what=what, reason=problem, hint=_TELL_AUTHORS)
        return
    if clash := _clash(kind, entry.name, module, others):
        thing, other = clash
        hint = "name one of the two" if other != "rcyaml" else _TELL_AUTHORS
        yield codes.PLUGIN_CLASH.at(plugin.span, name=plugin.name, what=thing, other=other, hint=hint)
        return
    plugin.modules[kind.name, entry.name] = module
    if kind.name == LANGUAGES:
        languages.add(module.LANGUAGE)


_TELL_AUTHORS = "report it to its authors, or try another version"


def _why_not(error: BaseException, name: str) -> str:
    if isinstance(error, ModuleNotFoundError) and error.name:
        return f"install it again, with its dependencies: `pip install --force-reinstall {name}`"
    return _TELL_AUTHORS


def _problem_of_codes(module: ModuleType) -> str:
    for code in codes_in(module):
        if not _CODE.fullmatch(code.id):
            return f"'{code.id}' is not a code: a code has two or more capital letters, and three or four digits"
        if _OWN_CODE.match(code.id):
            continue  # a code of rcyaml, which it may report; `_clash` compares them
        try:
            code.severity, code.message, code.entry  # noqa: B018 (raises if one is missing)
        except (KeyError, ValueError, OSError) as error:
            return f"the page of {code.id} is wrong: {reason_of(error)}"
    return ""


def _clash(kind: Kind, name: str, module: ModuleType, others: list[Plugin]) -> tuple[str, str] | None:
    """What a module defines that is defined already, and by whom; None if nothing."""
    if name in kind.built_in():
        return f"{kind.called} '{name}'", "rcyaml"
    for other in others:
        if kind.home and (kind.name, name) in other.modules:
            return f"{kind.called} '{name}'", f"plug-in '{other.name}'"
    for code in codes_in(module):
        if _OWN_CODE.match(code.id):
            from robocomp_yaml.diag.codes import table

            if table().get(code.id) != code:
                return f"diagnostic {code.id}", "rcyaml"
        for other in others:
            if other.codes.get(code.id, code) != code:
                return f"diagnostic {code.id}", f"plug-in '{other.name}'"
    return None


def _installed() -> dict[str, list[str]]:
    """All installed plug-ins, with the names of their extensions."""
    entries = {distribution.name: _entries(distribution) for distribution in metadata.distributions()}
    return {name: [entry.name for entry in found] for name, found in entries.items() if found}


def _missing(name: str) -> Hint:
    return _did_you_mean(name) or Hint(f"`pip install {name}` installs it into the environment of rcyaml")


def _did_you_mean(name: str) -> Hint | None:
    """A hint at the plug-in that was probably meant: one with a similar name, or with an extension of this name."""
    known = _installed()
    meant = suggest(name, known) or next((one for one, pieces in known.items() if name in pieces), None)
    return meaning(name, meant) if meant else None
