"""`rcyaml edit`: changes of deployments and components, without an editor; comments and layout stay."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from robocomp_yaml import languages
from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import CommandGroup
from robocomp_yaml.commands._plugin_choices import PluginChoice
from robocomp_yaml.commands.new import languages_with
from robocomp_yaml.diag import terminal

if TYPE_CHECKING:
    from robocomp_yaml.api.editing.changes import DocumentChange
    from robocomp_yaml.api.editing.editor import DocumentEditor, Revision

_deployment = click.option(
    "--deployment", metavar="DDSL", type=click.Path(exists=True),
    help="The deployment; by default, the only one of the workspace.",
)  # fmt: skip
_diff = click.option("--diff", "only_diff", is_flag=True, help="Show the change, and write nothing.")
_force = click.option("--force", is_flag=True, help="Write it even if it causes errors.")
_LISTS = {"implement": "implements", "require": "requires", "publish": "publishes", "subscribe": "subscribes"}
_SAID = {"subscribes": "subscribes to"}
_CARRIED = {"publishes": "TOPIC", "subscribes": "TOPIC"}


@click.group(cls=CommandGroup, short_help="Change a deployment or a component; comments and layout stay.")
def command() -> None:
    """Change a deployment or a component: connect, move, group, add, remove, rename, set.

    Each change is made in the document's text, where comments and layout stay. It is checked with all documents of the
    workspace, and not written if it causes errors. `undo` takes it back, as long as nobody else changes the document.
    """


def _writing(function: Callable[..., None]) -> Callable[..., None]:
    for option in (_options.text_or_json, _options.include, _force, _diff):
        function = option(function)
    return function


def _changing(name: str, short_help: str, *arguments: Callable[..., Any], opaque: bool = False) -> Callable[..., None]:
    """A command that makes one change of a deployment. The function makes the change of the command's arguments."""

    def decorate(make: Callable[..., DocumentChange]) -> None:
        @click.pass_context
        def run(ctx: click.Context, /, deployment: str | None, include: tuple[str, ...], only_diff: bool, force: bool,
                format_: str, **words: Any) -> None:  # fmt: skip
            document = _document(deployment, include)
            editor = _editor(document, include)
            if "value" in words:
                change: DocumentChange = editor.parameter(document, words["entry"], words["parameter"], words["value"])
            else:
                change = make(**words)
            _show(ctx, editor, editor.revise(document, change), only_diff=only_diff, force=force, format_=format_)

        decorated: Callable[..., Any] = run
        for argument in reversed(arguments):
            decorated = argument(decorated)
        decorated = _writing(_deployment(decorated))
        settings = {"ignore_unknown_options": True} if opaque else None
        command.command(name, short_help=short_help, help=make.__doc__, context_settings=settings)(decorated)

    return decorate


_entry = click.argument("entry")
_many = click.argument("names", metavar="NAME...", nargs=-1, required=True)


@_changing("connect", "Set the server of a required interface.", _entry, click.argument("port"), click.argument("to"))
def _(entry: str, port: str, to: str) -> DocumentChange:
    """Connect the required interface PORT of ENTRY to TO: an entry, one of its interfaces (mouth.Mouth), a group, or
    the proxy of an external server."""
    from robocomp_yaml.api.editing.changes import Connect

    return Connect(entry, port, to)


@_changing("disconnect", "Remove the server of a required interface.", _entry, click.argument("port"))
def _(entry: str, port: str) -> DocumentChange:
    """Remove what the deployment says about the server of PORT of ENTRY."""
    from robocomp_yaml.api.editing.changes import Disconnect

    return Disconnect(entry, port)


@_changing("topic", "Give a topic another name in the network.",
           _entry, click.argument("port"), click.argument("to", metavar="[NAME]", default=""))  # fmt: skip
def _(entry: str, port: str, to: str) -> DocumentChange:
    """Give the topic PORT of ENTRY the name NAME in this network; without NAME, its own name again. Publishers and
    subscribers of one name are connected."""
    from robocomp_yaml.api.editing.changes import NameTopic

    return NameTopic(entry, port, to)


@_changing("move", "Move an entry to another host.", _entry, click.argument("host"))
def _(entry: str, host: str) -> DocumentChange:
    """Let ENTRY run on HOST."""
    from robocomp_yaml.api.editing.changes import MoveEntry

    return MoveEntry(entry, host)


@_changing("add-host", "Add a host.", click.argument("name"), click.argument("address"),
           click.option("--user", default="", metavar="NAME", help="The user for ssh."),
           click.option("--path", default="", metavar="FOLDER", help="The folder of the deployment there."),
           click.option("--ssh-port", "port", type=click.IntRange(1, 65535), metavar="PORT", help="The port of ssh."),
           click.option("--identity", default="", metavar="FILE", help="The private key for ssh."),
           click.option("--known-hosts", default="", metavar="FILE", help="A file of keys of hosts for ssh."),
           click.option("--jump", default="", metavar="HOST", help="The host that ssh goes through."))  # fmt: skip
def _(
    name: str, address: str, user: str, path: str, port: int | None, identity: str, known_hosts: str, jump: str
) -> DocumentChange:  # fmt: skip
    """Add the host NAME with its ADDRESS. If it is the second one, all entries without a host get the first one."""
    from robocomp_yaml.api.editing.changes import AddHost

    return AddHost(name, address, user, path, port, identity, known_hosts, jump)


@_changing("remove-host", "Remove a host on which nothing runs.", click.argument("name"))
def _(name: str) -> DocumentChange:
    """Remove the host NAME."""
    from robocomp_yaml.api.editing.changes import RemoveHost

    return RemoveHost(name)


@_changing("group", "Make entries members of a group.", click.argument("group"), _many)
def _(group: str, names: tuple[str, ...]) -> DocumentChange:
    """Make entries or groups members of GROUP, which is added if it is missing."""
    from robocomp_yaml.api.editing.changes import GroupEntries

    return GroupEntries(group, names)


@_changing("ungroup", "Remove members from a group, or a group.",
           click.argument("group"), click.argument("names", metavar="[NAME]...", nargs=-1))  # fmt: skip
def _(group: str, names: tuple[str, ...]) -> DocumentChange:
    """Remove members from GROUP; without a NAME, remove the group. The entries stay."""
    from robocomp_yaml.api.editing.changes import UngroupEntries

    return UngroupEntries(group, names)


def _used(key: str) -> Callable[..., Any]:
    meaning = f"With --new: what it {_SAID.get(key, key)}; may be repeated."
    return click.option(f"--{key}", multiple=True, metavar=_CARRIED.get(key, "INTERFACE"), help=meaning)


@_changing("add", "Add a component or a program.",
           _entry, click.argument("what", metavar="COMPONENT|PROGRAM"), click.argument("args", nargs=-1),
           click.option("--program", "is_program", is_flag=True, help="It is a program with arguments."),
           click.option("--new", "is_new", is_flag=True, help="Write a new component with this name, and add it."),
           click.option("--language", type=PluginChoice(languages_with), default=languages.DEFAULT, show_default=True,
                        help="With --new: the language of its code."),
           *map(_used, _LISTS.values()),
           click.option("--host", default="", metavar="NAME", help="The host that it runs on."))  # fmt: skip
def _(
    entry: str, what: str, args: tuple[str, ...], is_program: bool, is_new: bool, language: str, host: str,
    **uses: tuple[str, ...],
) -> DocumentChange:  # fmt: skip
    """Add ENTRY: the component with this document or folder, with --new a new component, as `rcyaml new component`
    writes it, or with --program any program. Arguments of a program that begin with - follow after --."""
    from robocomp_yaml.api.editing.changes import AddEntry, AddNew

    if args and not is_program:
        raise click.UsageError("only a program has arguments here: add --program")
    if is_program and is_new:
        raise click.UsageError("--program and --new exclude each other")
    chosen = click.get_current_context().get_parameter_source("language") is not ParameterSource.DEFAULT
    if not is_new and (chosen or any(uses.values())):
        raise click.UsageError("only a new component gets these options: add --new")
    if is_new:
        return AddNew(entry, what, language, host=host, **uses)
    if is_program:
        return AddEntry(entry, program=what, args=args, host=host)
    return AddEntry(entry, component=what, host=host)


@_changing("remove", "Remove an entry, and what is connected to it.", _entry)
def _(entry: str) -> DocumentChange:
    """Remove ENTRY, and all connections, groups and orders of this document that name it."""
    from robocomp_yaml.api.editing.changes import RemoveEntry

    return RemoveEntry(entry)


@_changing("rename", "Rename an entry or a group wherever it is named.", _entry, click.argument("name"))
def _(entry: str, name: str) -> DocumentChange:
    """Rename ENTRY, which may be a group, to NAME."""
    from robocomp_yaml.api.editing.changes import RenameEntry

    return RenameEntry(entry, name)


@_changing("set", "Set a parameter in this network.",
           _entry, click.argument("parameter"), click.argument("value"), opaque=True)  # fmt: skip
def _() -> DocumentChange:
    """Set PARAMETER of ENTRY to VALUE, if its type and limits accept it. Text needs no quotes."""
    raise AssertionError


@_changing("unset", "Use a component's own value of a parameter.", _entry, click.argument("parameter"))
def _(entry: str, parameter: str) -> DocumentChange:
    """Remove PARAMETER of ENTRY, so that the value of the component's own configuration counts."""
    from robocomp_yaml.api.editing.changes import SetParameter

    return SetParameter(entry, parameter, None)


@_changing("port", "Set a TCP port.", _entry, click.argument("number", metavar="NUMBER|none"),
           click.option("--interface", default="", metavar="NAME",
                        help="The interface; by default, the first one."))  # fmt: skip
def _(entry: str, number: str, interface: str) -> DocumentChange:
    """Set the TCP port of ENTRY; none: a derived one."""
    from robocomp_yaml.api.editing.changes import SetPort

    if number != "none" and not number.isdecimal():
        raise click.UsageError(f"'{number}' is neither a number nor none")
    return SetPort(entry, None if number == "none" else int(number), interface)


@_changing("instances", "Set the number of processes.", _entry, click.argument("count", type=click.IntRange(1)))
def _(entry: str, count: int) -> DocumentChange:
    """Set the number of processes of ENTRY, whose name gets {i} if it has none."""
    from robocomp_yaml.api.editing.changes import SetInstances

    return SetInstances(entry, count)


@_changing("after", "Start an entry after others.", _entry, _many)
def _(entry: str, names: tuple[str, ...]) -> DocumentChange:
    """Let ENTRY start when these entries, services or groups are ready."""
    from robocomp_yaml.api.editing.changes import StartAfter

    return StartAfter(entry, names)


@_changing("not-after", "Do not start an entry after others.", _entry, _many)
def _(entry: str, names: tuple[str, ...]) -> DocumentChange:
    """Remove these names from the `after:` of ENTRY."""
    from robocomp_yaml.api.editing.changes import StartIndependently

    return StartIndependently(entry, names)


def _ports(name: str, key: str, *, adds: bool) -> None:
    what = _CARRIED.get(key, "INTERFACE")
    verb = f"Add {what.lower()}s to" if adds else f"Remove {what.lower()}s from"

    @command.command(name, short_help=f"{verb} what a component {_SAID.get(key, key)}.")
    @click.argument("component")
    @click.argument("interfaces", metavar=f"{what}...", nargs=-1, required=True)
    @_writing
    @click.pass_context
    def run(ctx: click.Context, component: str, interfaces: tuple[str, ...], include: tuple[str, ...],
            only_diff: bool, force: bool, format_: str) -> None:  # fmt: skip
        from robocomp_yaml.api import which
        from robocomp_yaml.api.editing.changes import from_json

        document = which.component(component)
        editor = _editor(document, include)
        revision = editor.revise(document, from_json({"change": name, "interface": interfaces}))
        _show(ctx, editor, revision, only_diff=only_diff, force=force, format_=format_)

    run.help = (
        f"{verb} what COMPONENT {_SAID.get(key, key)}{', with the imports that they need' if adds else ''}. COMPONENT "
        "is the document, folder or name of a component."
    )


for _name, _key in _LISTS.items():
    _ports(_name, _key, adds=True)
    _ports(f"un{_name}", _key, adds=False)


@command.command(short_help="Put a node of the picture at a position.")
@click.argument("name")
@click.argument("position", metavar="[X Y]", nargs=-1, type=click.FloatRange(0))
@_deployment
@_options.include
@_options.text_or_json
@click.pass_context
def place(
    ctx: click.Context, name: str, position: tuple[float, ...], deployment: str | None, include: tuple[str, ...],
    format_: str,
) -> None:  # fmt: skip
    """Put NAME, a process or a topic, at X and Y of the picture of `rcyaml manager` and `rcyaml graph --as json`:
    pixels from its upper left corner. Without X and Y, the picture decides."""
    from robocomp_yaml.api import load
    from robocomp_yaml.api.editing import layout
    from robocomp_yaml.api.refusals import require
    from robocomp_yaml.diag.render.json import dumps

    if len(position) not in (0, 2):
        raise click.UsageError("a position is two numbers: X Y", ctx)
    document = _document(deployment, include)
    picture = load(document, include=include).picture(document)
    if position and picture is not None:
        require("node", name, picture.nodes, document)
    layout.move(document, {name: (position[0], position[1]) if position else None})
    path = os.path.relpath(layout.path_of(document))
    if format_ == "json":
        terminal.data(
            dumps({"document": document, "layout": path, "name": name, "position": position or None}), json=True
        )
    elif ctx.obj.verbosity >= 0:
        terminal.say(f"wrote {path}: place {name}")


@command.command(short_help="Undo the last change of a document.")
@click.argument("document", metavar="[DOCUMENT]", default="")
@_options.include
@_options.text_or_json
@click.pass_context
def undo(ctx: click.Context, document: str, include: tuple[str, ...], format_: str) -> None:
    """Undo the last change of DOCUMENT, by default the only deployment, if it was not changed by anything else."""
    path = document or _document(None, include)
    _report(ctx, _editor(path, include).undo(path), format_, is_written=True)


@command.command(short_help="Make a change again that was undone.")
@click.argument("document", metavar="[DOCUMENT]", default="")
@_options.include
@_options.text_or_json
@click.pass_context
def redo(ctx: click.Context, document: str, include: tuple[str, ...], format_: str) -> None:
    """Make the change of DOCUMENT again that was undone last."""
    path = document or _document(None, include)
    _report(ctx, _editor(path, include).redo(path), format_, is_written=True)


def _document(deployment: str | None, include: tuple[str, ...]) -> str:
    from robocomp_yaml.api import which
    from robocomp_yaml.link.workspace import root_above

    return which.deployment(deployment or root_above("") or ".", include)


def _editor(document: str, include: tuple[str, ...]) -> DocumentEditor:
    from robocomp_yaml import api
    from robocomp_yaml.api.editing.editor import DocumentEditor
    from robocomp_yaml.link.workspace import root_above

    folder = os.path.dirname(document) or "."
    return DocumentEditor(api.follow(root_above(folder) or folder, include=include))


def _show(
    ctx: click.Context, editor: DocumentEditor, revision: Revision, *, only_diff: bool, force: bool, format_: str
) -> None:
    if not only_diff:
        editor.write(revision, force=force)
    elif format_ == "text":
        terminal.diff([revision.diff], _options.colored(ctx))
    _report(ctx, revision, format_, is_written=not only_diff)


def _report(ctx: click.Context, revision: Revision, format_: str, *, is_written: bool) -> None:
    """Prints what was changed, and the errors that it caused, and ends the command."""
    from robocomp_yaml.diag.render import tell
    from robocomp_yaml.diag.render.json import as_data, dumps

    if format_ == "json":
        errors = [as_data(one) for one in revision.new_errors]
        terminal.data(dumps({
            "document": revision.path, "change": revision.what, "written": is_written and not revision.is_empty,
            "version": revision.version, "diff": revision.diff, "errors": errors,
        }), json=True)  # fmt: skip
    else:
        if is_written and ctx.obj.verbosity >= 0:
            terminal.say(f"{'unchanged' if revision.is_empty else 'wrote'} {revision.path}: {revision.what}")
        if is_written and ctx.obj.verbosity > 0:
            terminal.diff([revision.diff], _options.colored(ctx))
        if revision.new_errors:
            texts = {revision.path: revision.after.decode("utf-8", "surrogateescape")}
            tell("text", revision.new_errors, revision.documents, _options.colored(ctx), err=True, texts=texts)
    ctx.exit(1 if revision.new_errors else 0)
