"""`rcyaml new interface|component|parameters|deployment`: a document that already checks, where its kind belongs.

An interface goes to the workspace's first folder of interfaces, a component to `components/` and a folder of its own,
which bears its name in lower case; parameters go beside their component, a deployment to `deployments/`. Where there is
no workspace yet, this folder becomes one.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import msgspec

from robocomp_yaml import languages
from robocomp_yaml.commands import _options, _workspace
from robocomp_yaml.commands._command import Group
from robocomp_yaml.commands._plugged import Plugged
from robocomp_yaml.diag import terminal
from robocomp_yaml.transactions import whole_file

if TYPE_CHECKING:
    from robocomp_yaml.plugins import Plugins

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_LONGEST_NAME = 200
_LISTS = {
    "implements": ("Speech", "interfaces that it serves to others"),
    "requires": ("Mouth", "interfaces of others that it calls, each through a proxy"),
    "publishes": ("SpeechEvents", "topics that it tells others about"),
    "subscribes": ("Asr", "topics that it listens to"),
}


class InterfaceView(msgspec.Struct, frozen=True):
    modeline: str
    module: str
    name: str


class ComponentView(msgspec.Struct, frozen=True):
    modeline: str
    name: str
    rows: list[str]


class NewDocument(msgspec.Struct, frozen=True):
    path: Path
    text: str


@click.group(cls=Group, short_help="Write a new interface, component, parameters or deployment document.")
def command() -> None:
    """Write a new document that already checks and compiles, commented as a tutorial.

    It goes where the workspace keeps its kind; a folder that belongs to no workspace becomes one.
    """


@command.command(short_help="A new interface document.")
@click.argument("name")
@click.pass_context
def interface(ctx: click.Context, name: str) -> None:
    """Write interfaces/NAME.idsl.yaml: a module with an interface NAME."""
    _create(ctx, lambda root: interface_document(root, name))


def _names(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Shell completion: the interfaces that the workspace defines."""
    from robocomp_yaml.commands.new_imports import interfaces_of

    root = _root()
    return [name for name in interfaces_of(root) if name.startswith(incomplete)] if root else []


def _languages(plugins: Plugins) -> list[str]:
    return [*languages.table(), *(one.name for one in plugins.languages)]


def _uses(name: str, meaning: str) -> Callable[[Any], Any]:
    return click.option(
        f"--{name}", multiple=True, metavar="INTERFACE", shell_complete=_names, help=f"The {meaning}; may be repeated."
    )


@command.command(short_help="A new component document.")
@click.argument("name")
@click.option("--language", type=Plugged(_languages), default=languages.DEFAULT, help="The language of its code.")
@_uses("implements", "interfaces that it serves")
@_uses("requires", "interfaces of others that it calls")
@_uses("publishes", "topics that it publishes")
@_uses("subscribes", "topics that it listens to")
@_options.include
@click.pass_context
def component(
    ctx: click.Context, /, name: str, language: str, include: tuple[str, ...], **uses: tuple[str, ...]
) -> None:
    """Write components/NAME/NAME.cdsl.yaml (in lower case): a component NAME.

    INTERFACE is the name of an interface or topic that a document of the workspace defines, or Module.Interface where
    several do.
    """
    _create(ctx, lambda root: component_document(root, name, language, uses, include))


@command.command(short_help="A new document of a component's parameters.")
@click.argument("name")
@click.pass_context
def parameters(ctx: click.Context, name: str) -> None:
    """Write the parameters' document of the component NAME, beside the component's."""
    _create(ctx, lambda root: parameters_document(root, name))


@command.command(short_help="A new deployment document.")
@click.argument("name")
@click.pass_context
def deployment(ctx: click.Context, name: str) -> None:
    """Write deployments/NAME.ddsl.yaml (in lower case): the components of the workspace, on this machine."""
    _create(ctx, lambda root: deployment_document(root, name), "deploy plan")


def deployment_document(root: Path, name: str) -> NewDocument:
    from robocomp_yaml.commands import new_deployment

    _refuse_odd(name)
    path, text = new_deployment.deployment_document(root, name)
    return NewDocument(_free(path), text)


def parameters_document(root: Path, name: str) -> NewDocument:
    from robocomp_yaml.commands import new_parameters

    _refuse_odd(name)
    path, text = new_parameters.parameters_document(root, name)
    return NewDocument(_free(path), text)


def interface_document(root: Path, name: str) -> NewDocument:
    from robocomp_yaml.commands.new_imports import interface_folder
    from robocomp_yaml.emit.render import render
    from robocomp_yaml.link.workspace_files import modeline

    _refuse_odd(name)
    path = _free(interface_folder(root) / f"{name}.idsl.yaml")
    view = InterfaceView(modeline("idsl", path, root), f"RoboComp{name[0].upper()}{name[1:]}", name)
    document = NewDocument(path, render("new/interface.idsl.yaml.j2", view))
    _refuse_faulty(document, name)
    return document


def component_document(
    root: Path, name: str, language: str, uses: Mapping[str, Sequence[str]], include: Sequence[str] = ()
) -> NewDocument:
    from robocomp_yaml.commands.new_imports import imports_for
    from robocomp_yaml.emit.render import render
    from robocomp_yaml.link.workspace_files import modeline

    _refuse_odd(name)
    path = _free(root / "components" / name.lower() / f"{name.lower()}.cdsl.yaml")
    for key, names in uses.items():
        for twice in {n for n in names if list(names).count(n) > 1}:
            raise click.UsageError(f"--{key} {twice} stands twice")
    imports = imports_for(root, path, [name for names in uses.values() for name in names], include)
    view = ComponentView(modeline("cdsl", path, root), name, list(_rows(language, imports, uses)))
    return NewDocument(path, render("new/component.cdsl.yaml.j2", view))


def write(ctx: click.Context, document: NewDocument) -> None:
    """Writes a document where nothing stands yet."""
    document.path.parent.mkdir(parents=True, exist_ok=True)
    whole_file.create(document.path, document.text)
    _workspace.tell(ctx, "wrote", document.path)


def _create(ctx: click.Context, make: Callable[[Path], NewDocument], next_: str = "compile") -> None:
    from robocomp_yaml.link import workspace_files

    root = _root()
    try:
        if root is None:
            root = Path()
            make(root)  # what is refused leaves no workspace behind
            _workspace.make(ctx, root)
        document = make(root)
        write(ctx, document)
        workspace_files.install(root)
    except OSError as error:
        raise _workspace.unwritable(error) from error
    if ctx.obj.verbosity >= 0:
        terminal.say(f"next: {terminal.typed('rcyaml', *next_.split(), str(document.path))}")


def _root() -> Path | None:
    from robocomp_yaml.link.workspace import root_above

    found = root_above(".")
    return None if found is None else Path(found)


def _refuse_odd(name: str) -> None:
    if not _NAME.fullmatch(name):
        raise click.UsageError(
            f"'{name}' cannot be a name: a name has letters, digits and underscores, and starts with no digit"
        )
    if len(name) > _LONGEST_NAME:
        raise click.UsageError(f"'{name[:20]}…' is longer than a name may be, {_LONGEST_NAME} letters")


def _free(path: Path) -> Path:
    if os.path.lexists(path):
        raise click.UsageError(f"{path} is there already, and stays as it is")
    return path


def _refuse_faulty(document: NewDocument, name: str) -> None:
    """Refuses a name that makes a faulty document, such as a reserved word of Slice."""
    from tempfile import TemporaryDirectory

    from robocomp_yaml.pipeline import analyse

    with TemporaryDirectory() as folder:
        path = os.path.join(folder, document.path.name)
        Path(path).write_text(document.text, encoding="utf-8")
        for diagnostic in analyse([path]).diagnostics:
            raise click.UsageError(f"'{name}' cannot be an interface: {diagnostic.message}")


def _rows(language: str, imports: Sequence[str], uses: Mapping[str, Sequence[str]]) -> Iterator[str]:
    """The lines of a component document below its name; what it does not have stands there as a comment."""
    yield _commented(f"language: {language}", f"or {_other(language)}")
    yield ""
    if imports:
        yield _commented(f"imports: [{', '.join(imports)}]", "the documents that define what is named below")
    else:
        yield _commented("# imports: [Speech]", "the documents that define what is named below")
    for key, (example, meaning) in _LISTS.items():
        names = uses.get(key, ())
        yield _commented(f"{key}: [{', '.join(names)}]" if names else f"# {key}: [{example}]", meaning)
    yield ""
    yield _commented("# period: 100 ms", "how often compute() runs")


def _other(language: str) -> str:
    """What may stand there instead."""
    standards = languages.language(language).standards
    if len(standards) > 1:
        return f"{{name: {language}, standard: {standards[1]}}}"
    return languages.listed(name for name in languages.table() if name != language)


def _commented(row: str, comment: str) -> str:
    return f"{row:<37} # {comment}"
