"""A process with other values for one run: documents with these values, which are only read, never written."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence

from robocomp_yaml.api import which
from robocomp_yaml.api.values import Values, parameter_at, spells_text
from robocomp_yaml.diag.diagnostic import ERROR
from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.link.deployments import LinkedInstance
from robocomp_yaml.parameters.editing.edit import NotEditable, set_value
from robocomp_yaml.parameters.types import is_secret
from robocomp_yaml.pipeline import Analysis, analyse
from robocomp_yaml.secrets import HIDDEN
from robocomp_yaml.semantics.paths import Step
from robocomp_yaml.source import text
from robocomp_yaml.source.tree import Mapping as Tree
from robocomp_yaml.source.tree import parse, value_at


def in_entry(
    analysis: Analysis, document: str, name: str, settings: Mapping[str, str], config: str, include: Sequence[str]
) -> Analysis:  # fmt: skip
    """The analysis of a deployment whose process `name` has these values under `set:`, and this file as `config:`.
    Raises Refused if it cannot have them."""
    instance = analysis.program.deployments[os.path.realpath(document)].instances.get(name)
    if instance is None or instance.component is None:
        raise Refused(f"'{name}' is not a component, so it has no parameters to set")
    path, parameters = instance.document.path, instance.component.parameters.parameters.root
    changed = _text(path)
    steps: list[Step] = ["components", _key(_tree(path, changed), instance)]
    for parameter, value in settings.items():
        _, type_ = parameter_at(parameter, parameters)
        is_text = spells_text(type_, value)
        if not is_text and parse(path, value)[1]:
            shown = HIDDEN if is_secret(type_) else f"'{value}'"
            raise Refused(f"--set {parameter}: {shown} is not a value in YAML")
        changed = _changed(path, changed, [*steps, "set", parameter], value, is_text=is_text)
    if config:
        below = os.path.relpath(config, os.path.dirname(path) or ".")
        changed = _changed(path, changed, [*steps, "config"], below, is_text=True)
    found = analyse([document], include, overlay={path: changed.encode()})
    # The document on the disk has not the lines to which these refer.
    problems = [one.message for one in found.diagnostics if one.severity == ERROR]
    if problems:
        raise Refused("; ".join(problems))
    return found


def in_values(
    analysis: Analysis, document: str, settings: Mapping[str, str], include: Sequence[str]
) -> Analysis:  # fmt: skip
    """The analysis of a component whose `etc/config.yaml` has these values. Raises Refused without such a document, and
    Faulty if they lead to errors."""
    path = os.path.normpath(os.path.join(os.path.dirname(document), which.VALUES))
    if not os.path.isfile(path):
        pairs = " ".join(f"--{name}={value}" for name, value in settings.items())
        raise Refused(f"{path} does not exist, so that --set cannot change it; `-- {pairs}` passes it to the program")
    overlay: dict[str, bytes] = {}
    for name, value in settings.items():
        overlay = {
            os.path.realpath(path): Values(path, include, overlay).set(name, value, replaces_references=True).after
        }
    read = analysis.documents
    requested = [read[real].path for real in analysis.program.requested if real in read]
    return analyse(requested, include, overlay=overlay)


def _key(root: Tree | None, instance: LinkedInstance) -> str:
    """The key of an instance's entry: that of an entry with `instances:` contains `{i}`."""
    entries = value_at(root, "components")
    names = [key.lexeme for key, _ in entries.items()] if isinstance(entries, Tree) else []
    number = "" if instance.number is None else str(instance.number)
    return next((one for one in names if one.replace("{i}", number) == instance.entry.name), instance.entry.name)


def _changed(path: str, content: str, steps: list[Step], value: str, *, is_text: bool) -> str:
    """The document with a value at these steps. Raises Refused if it cannot have one."""
    root = _tree(path, content)
    assert root is not None  # the analysis has read it
    try:
        return set_value(path, content, root, steps, value, is_text=is_text).text
    except NotEditable as error:
        raise Refused(f"{steps[-1]} cannot be set in {path}:{error.node.span.line}: {error}") from None


def _text(path: str) -> str:
    raw, _ = text.read_bytes(path)
    return (text.decode(path, raw)[0] or "") if raw is not None else ""


def _tree(path: str, content: str) -> Tree | None:
    root, _ = parse(path, content)
    return root if isinstance(root, Tree) else None
