"""What the commands share that talk to running components: options, completion, times, and values as YAML or JSON."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import click

from robocomp_yaml.commands._duration import Duration

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

    from robocomp_yaml.api.addresses import Addresses


class DeploymentName(click.ParamType):  # type: ignore[type-arg]  # older ones are not generic
    """A deployment: its document, or its name, as the path of the document."""

    name = "ddsl"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        from robocomp_yaml.api.refusals import meant
        from robocomp_yaml.commands._ddsl import known_names, named_document

        found = named_document(value)
        if not found:
            hint = meant(value, known_names())
            self.fail(f"there is no document '{value}', and no deployment of this name{hint}", param, ctx)
        return found

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        return click.Path(exists=True).shell_complete(ctx, param, incomplete)


def _default_deployment(ctx: click.Context, param: click.Parameter, value: str | None) -> str | None:
    """Where there are no documents, the only deployment that runs."""
    from robocomp_yaml.commands._ddsl import only_running

    return value or only_running() or None


deployment = click.option(
    "--deployment", metavar="DDSL", type=DeploymentName(), callback=_default_deployment,
    help="The deployment: its document, or its name; by default, the only one of the workspace, and without "
         "documents, the only one that runs.",
)  # fmt: skip
timeout = click.option("--timeout", type=Duration(), default="10s", metavar="TIME", show_default=True,
                       help="The longest time that a call may take.")  # fmt: skip
every = click.option("--every", type=Duration(), metavar="TIME", help="Call again after this time, until Ctrl-C.")
ending = click.option("--for", "duration", type=Duration(), metavar="TIME", help="End after this time.")
ice_config = click.option(
    "--ice-config", metavar="FILE", type=click.Path(exists=True, dir_okay=False),
    help="Properties of Ice, such as those of TLS.",
)  # fmt: skip
yaml_or_json = click.option("--format", "format_", type=click.Choice(["yaml", "json"]), default="yaml",
                            help="How to print values.")  # fmt: skip


def completing(known: Callable[[Addresses, str], list[str]]) -> Any:
    """The shell completion of an argument by names that `known` returns; it prints nothing, whatever is wrong."""

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        from click.shell_completion import CompletionItem

        from robocomp_yaml.api.addresses import Addresses
        from robocomp_yaml.diag.errors import Faulty, Refused

        try:
            names = known(Addresses(ctx.params.get("deployment") or ""), incomplete)
        except (Faulty, Refused, OSError):
            return []
        return [CompletionItem(name) for name in names if name.startswith(incomplete)]

    return complete


def reject_options(ctx: click.Context, words: Sequence[str], arguments: Collection[str]) -> None:
    """Raises click's error for a word that was meant as an option, or as one of the `arguments`: words may begin with
    `-`, so that click passes on what it does not know."""
    for word in words:
        option, _, value = word.partition("=")
        if option.startswith("--") and option[2:].partition(".")[0] in arguments:
            message = f"No such option '{option}': write {option[2:]}={value or '…'}, without `--`."
            raise click.NoSuchOption(option, message, ctx=ctx)
        if option.startswith("--"):
            known = [name for one in ctx.command.get_params(ctx) for name in one.opts if name.startswith("--")]
            raise click.NoSuchOption(option, possibilities=known, ctx=ctx)


def methods(addresses: Addresses, incomplete: str) -> list[str]:
    """The methods of all that have a name; those of CommonBehavior only after its name."""
    from robocomp_yaml.diag.errors import Refused

    names = []
    for name in addresses.names():
        try:
            names += addresses.methods(name)
        except Refused:
            continue
    return [name for name in names if incomplete.startswith(_shown_from(name))]


def _shown_from(name: str) -> str:
    """What must be typed before a method is offered: the first letter of CommonBehavior, which everybody has."""
    entry, common, _ = name.partition(".CommonBehavior.")
    return f"{entry}.C" if common else ""


def as_text(data: Mapping[str, Any], format_: str, *, line: bool = False) -> str:
    """Values as YAML or JSON, with a line end; JSON in one `line`, if wanted."""
    if format_ == "json":
        return as_json(data, line=line)
    from robocomp_yaml.source.yaml_text import block

    return block(data)


def as_json(data: object, *, line: bool = True) -> str:
    """Values as JSON with a line end. JSON has no numbers that are infinite or none: they are texts, as in Protobuf's
    JSON."""
    from robocomp_yaml.diag.render.json import dumps, plain

    return dumps(plain(data), indent=None if line else 2)


def standard_input() -> str:
    """The text on standard input; bytes that are not UTF-8 become surrogates, which arguments reject."""
    return sys.stdin.buffer.read().decode("utf-8-sig", "surrogateescape")


def times(count: int | None, period: float | None) -> Iterator[int]:
    """Counts, at most to `count`. Each number comes a multiple of the period after the first one, so that times do not
    drift; those that are missed are skipped."""
    began, at, number = time.monotonic(), 0, 0
    pause = threading.Event()
    while count is None or number < count:
        yield number
        number += 1
        if period and (count is None or number < count):
            now = time.monotonic() - began
            at = max(at + 1, int(now / period))
            pause.wait(max(0.0, at * period - now))
