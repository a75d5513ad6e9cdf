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


def _change(
    name: str, short_help: str, meaning: str, *arguments: Callable[..., Any], of: Callable[..., Any] = _deployment,
    make: Callable[..., dict[str, Any]] = dict, settings: dict[str, Any] | None = None,
) -> None:  # fmt: skip
    """A command that makes one change of a deployment or a component. `make` returns the change as JSON data; by
    default, these are the arguments of the command, with the command's name as that of the change."""

    @click.pass_context
    def run(ctx: click.Context, /, include: tuple[str, ...], only_diff: bool, force: bool, format_: str,
            deployment: str | None = None, component: str | None = None, **words: Any) -> None:  # fmt: skip
        from robocomp_yaml.api import which
        from robocomp_yaml.api.editing.changes import from_json

        document = _document(deployment, include) if component is None else which.component(component)
        editor = _editor(document, include)
        if name == "set":
            change: DocumentChange = editor.parameter(document, **words)
        else:
            change = from_json({"change": name, **make(**words)})
        revision = editor.revise(document, change)
        if not only_diff:
            editor.write(revision, force=force)
        elif format_ == "text":
            terminal.diff([revision.diff], _options.colored(ctx))
        _report(ctx, revision, format_, is_written=not only_diff)

    options = _options.together(_diff, _force, _options.include, _options.text_or_json, of, *arguments)
    command.command(name, short_help=short_help, help=meaning, context_settings=settings)(options(run))


def _members(metavar: str = "NAME...", name: str = "members", *, required: bool = True) -> Callable[..., Any]:
    return click.argument(name, metavar=metavar, nargs=-1, required=required)


def _used(key: str) -> Callable[..., Any]:
    meaning = f"With --new: what it {_SAID.get(key, key)}; may be repeated."
    return click.option(f"--{key}", multiple=True, metavar=_CARRIED.get(key, "INTERFACE"), help=meaning)


def _added(
    entry: str, what: str, args: tuple[str, ...], is_program: bool, is_new: bool, language: str, host: str,
    **uses: tuple[str, ...],
) -> dict[str, Any]:  # fmt: skip
    if args and not is_program:
        raise click.UsageError("only a program has arguments here: add --program")
    if is_program and is_new:
        raise click.UsageError("--program and --new exclude each other")
    chosen = click.get_current_context().get_parameter_source("language") is not ParameterSource.DEFAULT
    if not is_new and (chosen or any(uses.values())):
        raise click.UsageError("only a new component gets these options: add --new")
    if is_new:
        return {"change": "add-new", "entry": entry, "component": what, "language": language, "host": host, **uses}
    return {"entry": entry, "program" if is_program else "component": what, "args": args, "host": host}


def _port(entry: str, number: str, interface: str) -> dict[str, Any]:
    if number != "none" and not number.isdecimal():
        raise click.UsageError(f"'{number}' is neither a number nor none")
    return {"entry": entry, "number": None if number == "none" else int(number), "interface": interface}


_entry, _topic_or_interface = click.argument("entry"), click.argument("port")

_change("connect", "Set the server of a required interface.",
        "Connect the required interface PORT of ENTRY to TO: an entry, one of its interfaces (mouth.Mouth), a group, "
        "or the proxy of an external server.", _entry, _topic_or_interface, click.argument("to"))  # fmt: skip
_change("disconnect", "Remove the server of a required interface.",
        "Remove what the deployment says about the server of PORT of ENTRY.", _entry, _topic_or_interface)  # fmt: skip
_change("topic", "Give a topic another name in the network.",
        "Give the topic PORT of ENTRY the name NAME in this network; without NAME, its own name again. Publishers and "
        "subscribers of one name are connected.",
        _entry, _topic_or_interface, click.argument("to", metavar="[NAME]", default=""))  # fmt: skip
_change("move", "Move an entry to another host.", "Let ENTRY run on HOST.", _entry, click.argument("host"))
_change("add-host", "Add a host.",
        "Add the host NAME with its ADDRESS. If it is the second one, all entries without a host get the first one.",
        click.argument("name"), click.argument("address"),
        click.option("--user", default="", metavar="NAME", help="The user for ssh."),
        click.option("--path", default="", metavar="FOLDER", help="The folder of the deployment there."),
        click.option("--ssh-port", "port", type=click.IntRange(1, 65535), metavar="PORT", help="The port of ssh."),
        click.option("--identity", default="", metavar="FILE", help="The private key for ssh."),
        click.option("--known-hosts", default="", metavar="FILE", help="A file of keys of hosts for ssh."),
        click.option("--jump", default="", metavar="HOST", help="The host that ssh goes through."))  # fmt: skip
_change("remove-host", "Remove a host on which nothing runs.", "Remove the host NAME.", click.argument("name"))
_change("group", "Make entries members of a group.",
        "Make entries or groups members of GROUP, which is added if it is missing.",
        click.argument("group"), _members())  # fmt: skip
_change("ungroup", "Remove members from a group, or a group.",
        "Remove members from GROUP; without a NAME, remove the group. The entries stay.",
        click.argument("group"), _members("[NAME]...", required=False))  # fmt: skip
_change("add", "Add a component or a program.",
        "Add ENTRY: the component with this document or folder, with --new a new component, as `rcyaml new component` "
        "writes it, or with --program any program. Arguments of a program that begin with - follow after --.",
        _entry, click.argument("what", metavar="COMPONENT|PROGRAM"), click.argument("args", nargs=-1),
        click.option("--program", "is_program", is_flag=True, help="It is a program with arguments."),
        click.option("--new", "is_new", is_flag=True, help="Write a new component with this name, and add it."),
        click.option("--language", type=PluginChoice(languages_with), default=languages.DEFAULT, show_default=True,
                     help="With --new: the language of its code."),
        *map(_used, _LISTS.values()),
        click.option("--host", default="", metavar="NAME", help="The host that it runs on."),
        make=_added)  # fmt: skip
_change("remove", "Remove an entry, and what is connected to it.",
        "Remove ENTRY, and all connections, groups and orders of this document that name it.", _entry)  # fmt: skip
_change("rename", "Rename an entry or a group wherever it is named.", "Rename ENTRY, which may be a group, to NAME.",
        _entry, click.argument("name"))  # fmt: skip
_change("set", "Set a parameter in this network.",
        "Set PARAMETER of ENTRY to VALUE, if its type and limits accept it. Text needs no quotes.",
        _entry, click.argument("parameter"), click.argument("text", metavar="VALUE"),
        settings={"ignore_unknown_options": True})  # fmt: skip
_change("unset", "Use a component's own value of a parameter.",
        "Remove PARAMETER of ENTRY, so that the value of the component's own configuration counts.",
        _entry, click.argument("parameter"),
        make=lambda **words: {"change": "set", "value": None, **words})  # fmt: skip
_change("port", "Set a TCP port.", "Set the TCP port of ENTRY; none: a derived one.",
        _entry, click.argument("number", metavar="NUMBER|none"),
        click.option("--interface", default="", metavar="NAME", help="The interface; by default, the first one."),
        make=_port)  # fmt: skip
_change("instances", "Set the number of processes.",
        "Set the number of processes of ENTRY, whose name gets {i} if it has none.",
        _entry, click.argument("count", type=click.IntRange(1)))  # fmt: skip
_change("after", "Start an entry after others.",
        "Let ENTRY start when these entries, services or groups are ready.",
        _entry, _members(name="needed"))  # fmt: skip
_change("not-after", "Do not start an entry after others.",
        "Remove these names from the `after:` of ENTRY.", _entry, _members(name="needed"))  # fmt: skip


def _ports(name: str, key: str, *, adds: bool) -> None:
    what, does = _CARRIED.get(key, "INTERFACE"), _SAID.get(key, key)
    verb = f"Add {what.lower()}s to" if adds else f"Remove {what.lower()}s from"
    needed = ", with the imports that they need" if adds else ""
    meaning = f"{verb} what COMPONENT {does}{needed}. COMPONENT is the document, folder or name of a component."
    interfaces = _members(f"{what}...", "interface")
    _change(name, f"{verb} what a component {does}.", meaning, interfaces, of=click.argument("component"))


for _name, _key in _LISTS.items():
    _ports(_name, _key, adds=True)
    _ports(f"un{_name}", _key, adds=False)


@command.command(short_help="Put a node of the picture at a position.")
@click.argument("name")
@click.argument("position", metavar="[X Y]", nargs=-1, type=click.FloatRange(0))
@_deployment
@_options.reading
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


def _historical(name: str, short_help: str, meaning: str) -> None:
    @command.command(name, short_help=short_help, help=meaning)
    @click.argument("document", metavar="[DOCUMENT]", default="")
    @_options.reading
    def run(ctx: click.Context, document: str, include: tuple[str, ...], format_: str) -> None:
        path = document or _document(None, include)
        editor = _editor(path, include)
        _report(ctx, editor.undo(path) if name == "undo" else editor.redo(path), format_, is_written=True)


_historical(
    "undo",
    "Undo the last change of a document.",
    "Undo the last change of DOCUMENT, by default the only deployment, if it was not changed by anything else.",
)
_historical("redo", "Make a change again that was undone.", "Make the change of DOCUMENT again that was undone last.")


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
