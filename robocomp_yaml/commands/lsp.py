"""`rcyaml lsp`: the language server, for editors."""

from __future__ import annotations

import click

from robocomp_yaml.commands import _options
from robocomp_yaml.commands._command import LibraryCommand
from robocomp_yaml.diag import extras


@click.command(cls=LibraryCommand, short_help="Serve editors: diagnostics as you type, fixes, formatting.")
@click.option("--stdio", is_flag=True, help="What many editors pass: use standard input and output, as always.")
@_options.include
@click.pass_context
def command(ctx: click.Context, stdio: bool, include: tuple[str, ...]) -> None:
    """Serve an editor by the language server protocol, on standard input and output.

    Editors start it by themselves: the page "In the editor" of the documentation shows how. It needs pygls: pip install
    'rcyaml[lsp]'.
    """
    try:
        from robocomp_yaml.lsp import features
    except ImportError as error:
        if (error.name or "").partition(".")[0] not in ("pygls", "lsprotocol"):
            raise
        raise click.UsageError(f"lsp needs pygls: {extras.command('lsp')}", ctx) from None
    features.make(include).start_io()
