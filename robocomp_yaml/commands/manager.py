"""`rcyaml manager`: a network in the browser, or for programs by HTTP."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import click

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import LibraryCommand
from robocomp_yaml.deploy.engines import ENGINES
from robocomp_yaml.diag import extras, terminal

if TYPE_CHECKING:
    from robocomp_yaml.manager.access import AccessRules
    from robocomp_yaml.manager.serving import Listening

_LIBRARIES = ("starlette", "uvicorn", "anyio", "h11")


@click.command(cls=LibraryCommand, short_help="Serve a network to browsers and programs: see it, and change it.")
@click.argument("ddsl", metavar="[DDSL]...", nargs=-1, type=click.Path(exists=True))
@click.option("--read-only", is_flag=True, help="Nothing can be changed.")
@click.option("--operate", is_flag=True, help="What runs can be changed, and no document.")
@click.option("--port", type=click.IntRange(1, 65535), help="The TCP port; by default 7410, or a free one.")
@click.option("--listen", metavar="ADDRESS", help="Listen at this address instead of this machine's own.")
@click.option("--cert", type=click.Path(exists=True, dir_okay=False), help="The certificate, for --listen.")
@click.option("--key", type=click.Path(exists=True, dir_okay=False), help="The key of the certificate.")
@click.option("--unix", metavar="PATH", type=click.Path(), help="Listen on a unix socket instead of a port.")
@click.option("--no-browser", is_flag=True, help="Do not open a browser.")
@click.option("--engine", type=click.Choice([*ENGINES]), help="The engine: local for one machine, icegrid for several.")
@_options.include
@click.pass_context
def command(
    ctx: click.Context, ddsl: tuple[str, ...], read_only: bool, operate: bool, port: int | None, listen: str | None,
    cert: str | None, key: str | None, unix: str | None, no_browser: bool, engine: str | None,
    include: tuple[str, ...],
) -> None:  # fmt: skip
    """Serve deployments until Ctrl-C: by default, the only one below this folder. The network goes on when the manager
    ends.

    What it serves, it serves to this user of this machine: the printed address contains a token. --listen ADDRESS
    serves it to others, encrypted, with --cert and --key. It needs Starlette and uvicorn: pip install
    'rcyaml[manager]'.
    """
    if read_only and operate:
        raise click.UsageError("--read-only and --operate exclude each other", ctx)
    if unix and (listen or port):
        raise click.UsageError("--unix has no address and no port", ctx)
    if bool(cert) != bool(key):
        raise click.UsageError("--cert and --key belong together", ctx)
    if listen and not cert and not _is_own(listen):
        raise click.UsageError(
            f"--listen {listen} needs --cert and --key: others could read what you send. To use it from another "
            "machine, type there: ssh -L 7410:localhost:7410 HOST",
            ctx,
        )
    try:
        from robocomp_yaml.manager.access import EDIT, OPERATE, READ
        from robocomp_yaml.manager.serving import LOOPBACK, Listening, bound, rules_for, serve
    except ImportError as error:
        if (error.name or "").partition(".")[0] not in _LIBRARIES:
            raise
        raise click.UsageError(f"manager needs Starlette and uvicorn: {extras.command('manager')}", ctx) from None
    from robocomp_yaml.api import which
    from robocomp_yaml.manager.managed import ManagedDeployment
    from robocomp_yaml.manager.watching import Watcher
    from robocomp_yaml.source.discover import kind_of

    documents = list(dict.fromkeys(os.path.normpath(which.deployment(one, include)) for one in ddsl or (".",)))
    for path in documents:
        if kind_of(path) != "ddsl":
            raise click.UsageError(f"'{path}' is neither a deployment document (NAME.ddsl.yaml) nor a folder", ctx)
    rights = (READ,) if read_only else (READ, OPERATE) if operate else (READ, OPERATE, EDIT)
    where = Listening(listen or LOOPBACK, port or 0, unix or "", cert or "", key or "")
    watchers = {
        name: Watcher(ManagedDeployment(path, include, engine)) for name, path in _named(documents).items()
    }  # fmt: skip
    page = _page()
    made = bound(where)
    rules = rules_for(made, where, rights)

    def on_ready() -> None:
        _print(rules, where, documents)
        if page is None:
            terminal.say("its page is not installed: pip install rcyaml-manager (here: pip install ./web)", err=True)
        elif not no_browser and not unix and _has_display():
            import webbrowser

            from robocomp_yaml.manager.serving import address

            webbrowser.open(address(rules, where))

    ctx.exit(serve(watchers, made, where, rules, page, on_ready))


def _page() -> dict[str, str] | None:
    """The files of the page, None if it is not installed."""
    try:
        import rcyaml_manager
    except ImportError:
        return None
    return rcyaml_manager.files() or None


def _named(documents: list[str]) -> dict[str, str]:
    """The documents by the names of their deployments, or with a number if several have one."""
    from robocomp_yaml.source.heading import root_of
    from robocomp_yaml.source.tree import Scalar

    named: dict[str, str] = {}
    for path in documents:
        root = root_of(path)
        node = root.get("deployment") if root is not None else None
        name = node.lexeme if isinstance(node, Scalar) else os.path.basename(path).removesuffix(".ddsl.yaml")
        number = sum(1 for one in named if one == name or one.startswith(f"{name}-"))
        named[f"{name}-{number + 1}" if name in named else name] = path
    return named


def _print(rules: AccessRules, where: Listening, documents: list[str]) -> None:
    from robocomp_yaml.manager.serving import address

    if where.path:
        path, port = os.path.abspath(where.path), 7410
        terminal.say(
            f"{', '.join(documents)}: on {where.path}", f"token: {rules.token}",
            f"from your machine: ssh -L {port}:{terminal.typed(path)} HOST, and open "
            f"http://localhost:{port}/?token={rules.token}",
        )  # fmt: skip
    else:
        terminal.say(f"{', '.join(documents)}: {address(rules, where)}")
        if "SSH_CONNECTION" in os.environ and _is_own(where.address):
            port, host = rules.port, os.environ["SSH_CONNECTION"].split()[2:3]
            terminal.say(f"from your machine: ssh -L {port}:localhost:{port} {''.join(host) or 'HOST'}")
    terminal.say("Ctrl-C ends the manager; the network goes on")


def _is_own(address: str) -> bool:
    """Whether only this machine reaches an address."""
    import ipaddress

    try:
        return ipaddress.ip_address(address).is_loopback
    except ValueError:
        return address == "localhost"


def _has_display() -> bool:
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
