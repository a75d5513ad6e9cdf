"""New interface, component and parameters documents: their paths and texts. The functions raise Refused if the name is
not possible, or the document exists."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from tempfile import TemporaryDirectory

import msgspec

from robocomp_yaml import languages
from robocomp_yaml.api.new.imports import imports_for, interface_folder
from robocomp_yaml.api.refusals import meant
from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.emit.render import render
from robocomp_yaml.link.documents import Documents
from robocomp_yaml.link.workspace_files import modeline
from robocomp_yaml.model.component import Component
from robocomp_yaml.pipeline import analyse
from robocomp_yaml.source.discover import of_kind

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_LONGEST_NAME = 200
_LISTS = {
    "implements": ("Speech", "interfaces that it serves to others"),
    "requires": ("Mouth", "interfaces of others that it calls, each through a proxy"),
    "publishes": ("SpeechEvents", "topics whose events it publishes"),
    "subscribes": ("Asr", "topics whose events it receives"),
}


class NewDocument(msgspec.Struct, frozen=True):
    path: str
    text: str


def interface_document(root: str, name: str) -> NewDocument:
    require_name(name)
    path = free(os.path.join(interface_folder(root), f"{name}.idsl.yaml"))
    module = f"RoboComp{name[0].upper()}{name[1:]}"
    head = modeline("idsl", path, root)
    document = NewDocument(path, render("new/interface.idsl.yaml.j2", modeline=head, module=module, name=name))
    _refuse_faulty(document, name)
    return document


def component_document(
    root: str, name: str, language: str, uses: Mapping[str, Sequence[str]], include: Sequence[str] = ()
) -> NewDocument:
    require_name(name)
    path = free(os.path.join(root, "components", name.lower(), f"{name.lower()}.cdsl.yaml"))
    for key, names in uses.items():
        for twice in {n for n in names if list(names).count(n) > 1}:
            raise Refused(f"--{key} {twice} is repeated")
    imports = imports_for(root, path, [name for names in uses.values() for name in names], include)
    rows = list(_rows(language, imports, uses))
    head = modeline("cdsl", path, root)
    return NewDocument(path, render("new/component.cdsl.yaml.j2", modeline=head, name=name, rows=rows))


def parameters_document(root: str, name: str) -> NewDocument:
    """The parameters document of the component `name`, beside the component; if there is no such component yet, where
    it would be."""
    require_name(name)
    component = _component(root, name) or os.path.join(root, "components", name.lower(), f"{name.lower()}.cdsl.yaml")
    path = free(component.removesuffix("cdsl.yaml") + "pdsl.yaml")
    shown = os.path.basename(component) if os.path.isfile(component) else name
    head = modeline("pdsl", path, root)
    return NewDocument(path, render("new/parameters.pdsl.yaml.j2", modeline=head, component=shown))


def require_name(name: str) -> None:
    if not _NAME.fullmatch(name):
        raise Refused(
            f"'{name}' is not a name: a name has letters, digits and underscores, and does not start with a digit"
        )
    if len(name) > _LONGEST_NAME:
        raise Refused(f"'{name[:20]}…' is too long: a name has at most {_LONGEST_NAME} characters")


def free(path: str) -> str:
    path = os.path.normpath(path)
    if os.path.lexists(path):
        raise Refused(f"{path} exists already, and is kept as it is")
    return path


def _refuse_faulty(document: NewDocument, name: str) -> None:
    """Raises Refused if a name gives a document with errors, such as a reserved word of Slice."""
    with TemporaryDirectory() as folder:
        path = os.path.join(folder, os.path.basename(document.path))
        with open(path, "w", encoding="utf-8") as file:
            file.write(document.text)
        for diagnostic in analyse([path]).diagnostics:
            raise Refused(f"'{name}' cannot be an interface: {diagnostic.message}")


def _rows(language: str, imports: Sequence[str], uses: Mapping[str, Sequence[str]]) -> Iterator[str]:
    """The lines of a component document below its name. Keys that it does not use are comments."""
    yield _commented(f"language: {language}", f"or {_other(language)}")
    yield ""
    row = f"imports: [{', '.join(imports)}]" if imports else "# imports: [Speech]"
    yield _commented(row, "the documents that define the interfaces below")
    for key, (example, meaning) in _LISTS.items():
        names = uses.get(key, ())
        yield _commented(f"{key}: [{', '.join(names)}]" if names else f"# {key}: [{example}]", meaning)
    yield ""
    yield _commented("# period: 100 ms", "how often compute() runs")


def _other(language: str) -> str:
    """The alternatives to a language."""
    standards = languages.language(language).standards
    if len(standards) > 1:
        return f"{{name: {language}, standard: {standards[1]}}}"
    return languages.listed(name for name in languages.table() if name != language)


def _commented(row: str, comment: str) -> str:
    return f"{row:<37} # {comment}"


def _component(root: str, name: str) -> str | None:
    """The path of the component document of this name, by the component's name or that of its file; None if there is
    none yet. Raises Refused if a component without parameters has a similar name, or the component has parameters."""
    documents = Documents()
    found: dict[str, bool] = {}
    without: list[str] = []
    for path in of_kind(root, "cdsl"):
        model = documents.get(path).model
        own_name = model.name if isinstance(model, Component) else ""
        stem = os.path.basename(path).removesuffix(".cdsl.yaml")
        has_parameters = isinstance(model, Component) and bool(model.parameters)
        if name.lower() in (own_name.lower(), stem.lower()):
            found[path] = has_parameters
        elif not has_parameters and not of_kind(os.path.dirname(path), "pdsl"):
            without += [own_name, stem]
    if len(found) > 1:
        raise Refused(f"several components have the name '{name}': {', '.join(found)}")
    for path, has_parameters in found.items():
        if has_parameters:
            raise Refused(f"{path} has a parameters document already")
        return path
    if hint := meant(name, filter(None, without)):
        raise Refused(f"unknown component '{name}'{hint} Otherwise `rcyaml new component {name}` comes first")
    return None
