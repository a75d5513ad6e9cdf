"""`rcyaml record`: messages of topics in MCAP files."""

from __future__ import annotations

import re
import time
from typing import TYPE_CHECKING, Any

import click

from robocomp_yaml.commands import _options, _talking
from robocomp_yaml.commands._arriving import arriving_messages
from robocomp_yaml.commands._command import CommandGroup, LibraryCommand
from robocomp_yaml.commands.topic import arriving_options, topic_names, with_topics
from robocomp_yaml.diag import terminal

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

    from robocomp_yaml.api.addresses import Addresses
    from robocomp_yaml.api.recording import Recorder, RecordingInfo
    from robocomp_yaml.api.topics import Topics
    from robocomp_yaml.commands._arriving import Arriving

PAUSE = 0.05  # seconds: messages are written in batches, which is cheaper than one by one
_UNITS = {"": 1, "k": 10**3, "m": 10**6, "g": 10**9}


class _Size(click.ParamType):  # type: ignore[type-arg]  # older ones are not generic
    """A size such as 500MB; in bytes."""

    name = "size"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int:
        found = re.fullmatch(r"(\d+(?:\.\d+)?) *([kmg]?)b?", str(value).strip().lower())
        size = round(float(found[1]) * _UNITS[found[2]]) if found else 0
        if not size:
            self.fail(f"'{value}' is not a size, such as 500MB or 2GB", param, ctx)
        return size


class _Group(CommandGroup):
    """`rcyaml record TOPIC...` is `rcyaml record start TOPIC...`."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        if not args or (args[0] not in self.commands and args[0] not in ctx.help_option_names):
            args = ["start", *args]
        return super().parse_args(ctx, args)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """The options of `start`, which are those of this command, too."""
        self.commands["start"].format_options(ctx, formatter)
        self.format_commands(ctx, formatter)


@click.group(cls=_Group, short_help="Record topics to MCAP files, and play them.", invoke_without_command=False,
             subcommand_metavar="[TOPIC]... | COMMAND [ARGS]...")  # fmt: skip
def command() -> None:
    """Record the messages of TOPICs, by default of all topics of the deployment, to an MCAP file with Protobuf, until
    Ctrl-C. TOPIC.MESSAGE means only this one.

    Readers of MCAP decode the values. The file is complete at any time: what a killed recorder leaves can be read.
    """


@command.command(short_help="Record topics (the default).", cls=LibraryCommand)
@click.argument("names", nargs=-1, metavar="[TOPIC]...", shell_complete=_talking.completing(topic_names))
@click.option("-o", "--output", default="", metavar="FILE", help="The new file; by default, named after the deployment "
              "and the time.")  # fmt: skip
@click.option("--max-size", type=_Size(), metavar="SIZE", help="End before the file is larger: 500MB, 2GB.")
@arriving_options
@click.pass_context
def start(
    ctx: click.Context, topics: Topics, names: tuple[str, ...], output: str, max_size: int | None, count: int | None,
    duration: float | None, type_: str, format_: str,
) -> None:  # fmt: skip
    """Record the messages of TOPICs, by default of all topics of the deployment, until Ctrl-C. TOPIC.MESSAGE means only
    this one."""
    from robocomp_yaml.api import recording
    from robocomp_yaml.diag.errors import Refused

    chosen = [topics.find(name, type_) for name in names] or [(one, "") for one in topics.documented]
    if not chosen:
        raise Refused("these documents have no topics; name those to record")
    deployment = network.name if (network := topics.addresses.network) else ""
    path = output or recording.default_path(deployment)
    with _options.writing(path), arriving_messages(topics, chosen, duration) as arriving:
        distinct = list(dict.fromkeys(topic for topic, _ in chosen))
        recorder = recording.Recorder(path, distinct, deployment, max_size)
        try:
            if ctx.obj.verbosity >= 0 and format_ == "text":
                terminal.say(f"recording {', '.join(one.name for one in distinct)} to {path}; Ctrl-C ends it", err=True)
            is_full = _record(recorder, arriving, count)
        finally:
            recorder.close(arriving.dropped)
            if format_ == "json":
                dropped = dict(arriving.dropped)
                data = {"file": path, "messages": recorder.messages, "size": recorder.size, "dropped": dropped}
                terminal.data(_talking.as_json(data, line=False), json=True)
            elif ctx.obj.verbosity >= 0:
                terminal.say(f"{path}: {recorder.messages} messages, {_bytes(recorder.size)}", err=True)
        if is_full and ctx.obj.verbosity >= 0:
            terminal.say(f"ended, because the file would be larger than {_bytes(max_size or 0)}", err=True)


def _record(recorder: Recorder, arriving: Arriving, count: int | None) -> bool:
    """Records until it is enough. Returns whether the file has reached its largest size."""
    while True:
        left = None if count is None else count - recorder.messages
        for message in arriving.drain(left):
            if not recorder.add(message):
                return True
        if count is not None and recorder.messages >= count:
            return False
        recorder.checkpoint_if_due()
        if not arriving.may_continue:
            return False
        time.sleep(PAUSE)


@command.command(short_help="Print what a file contains.", cls=LibraryCommand)
@click.argument("file", type=click.Path(exists=True, dir_okay=False))
@_options.text_or_json
def info(file: str, format_: str) -> None:
    """Print the topics in FILE with their types, how many messages they have, and how many were dropped."""
    from msgspec.structs import asdict

    from robocomp_yaml.api import recording

    found = recording.info(file)
    if format_ == "json":
        data = {**asdict(found), "topics": [asdict(one) for one in found.topics]}
        terminal.data(_talking.as_json(data, line=False), json=True)
        return
    terminal.say(*_info_lines(found))


def _info_lines(found: RecordingInfo) -> list[str]:
    seconds = found.end - found.begin
    at = time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(found.begin)) if found.messages else "-"
    rows = [("MESSAGE", "CARRIES", "NUMBER", "PER SECOND")]
    for one in found.topics:
        rate = f"{(one.messages - 1) / seconds:.1f}" if one.messages > 1 and seconds else "-"
        name = f"{one.topic}.{one.method}" if one.topic else one.channel
        rows.append((name, one.type, str(one.messages), rate))
    lines = [
        f"{found.path}: {found.messages} messages in {seconds:.1f} s, {_bytes(found.size)}",
        f"from {at}" + (f", deployment {found.deployment}" if found.deployment else ""),
    ]
    if found.dropped is None:
        lines.append("the recorder still runs, or was killed: the last seconds are missing")
    elif found.dropped:
        lines.append("dropped: " + ", ".join(f"{number} of {name}" for name, number in found.dropped.items()))
    return [*lines, *terminal.table(rows, right=(2, 3))]


def _complete_recorded(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """The topics in the file."""
    from robocomp_yaml.api import recording

    def known(addresses: Addresses, incomplete: str) -> list[str]:
        return sorted({one.topic for one in recording.info(ctx.params.get("file") or "").topics if one.topic})

    found: list[CompletionItem] = _talking.completing(known)(ctx, param, incomplete)
    return found


@command.command(short_help="Publish what a file contains.", cls=LibraryCommand)
@click.argument("file", type=click.Path(exists=True, dir_okay=False))
@click.argument("names", nargs=-1, metavar="[TOPIC]...", shell_complete=_complete_recorded)
@click.option("--rate", type=click.FloatRange(0), default=1.0, show_default=True, metavar="N",
              help="N times as fast; 0: as fast as possible.")  # fmt: skip
@with_topics
@click.pass_context
def play(
    ctx: click.Context, topics: Topics, file: str, names: tuple[str, ...], rate: float, format_: str
) -> None:  # fmt: skip
    """Publish the messages in FILE, by default of all its TOPICs, with the times between them as recorded. Another
    network is that of --deployment, or that of --storm."""
    from robocomp_yaml.api.recording import Player

    sent = 0

    def count(number: int) -> None:
        nonlocal sent
        sent = number

    player = Player(file, topics, names)
    try:
        player.play(rate, count)
    finally:
        if format_ == "json":
            terminal.data(_talking.as_json({"file": file, "sent": sent}, line=False), json=True)
        elif ctx.obj.verbosity >= 0:
            terminal.say(f"{file}: {sent} messages published", err=True)


def _bytes(number: float) -> str:
    for unit in ("bytes", "KB", "MB"):
        if number < 1000:
            return f"{number:.0f} {unit}" if unit == "bytes" else f"{number:.1f} {unit}"
        number /= 1000
    return f"{number:.1f} GB"
