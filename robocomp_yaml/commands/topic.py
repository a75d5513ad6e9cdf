"""`rcyaml topic`: the topics of a running network."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import click

from robocomp_yaml.commands import _options, _talking
from robocomp_yaml.commands._arriving import arriving_messages
from robocomp_yaml.commands._command import CommandGroup
from robocomp_yaml.commands._duration import Duration
from robocomp_yaml.diag import terminal

if TYPE_CHECKING:
    from robocomp_yaml.api.addresses import Addresses
    from robocomp_yaml.api.topics import KnownTopic, Message, Topics


def topic_names(addresses: Addresses, incomplete: str) -> list[str]:
    from robocomp_yaml.api.topics import Topics

    return [one.name for one in Topics(addresses).documented]


def _message_names(addresses: Addresses, incomplete: str) -> list[str]:
    from robocomp_yaml.api.topics import Topics

    known = [one for one in Topics(addresses).documented if one.interface is not None]
    return [f"{one.name}.{method.name}" for one in known if one.interface for method in one.interface.methods]


_storm = click.option("--storm", default="", metavar="PROXY", help="IceStorm's topic manager, or its HOST:PORT; "
                      "by default, that of the deployment, else at port 9999.")  # fmt: skip
type_option = click.option(
    "--type", "type_", default="", metavar="NAME",
    help="The topic of the documents that it carries, if its name does not say it.",
)  # fmt: skip
count_option = click.option("--count", type=click.IntRange(1), metavar="N", help="End after N messages.")


def with_topics(function: Callable[..., None]) -> Callable[..., None]:
    """The options of all these commands, of which the function gets the topics."""
    from functools import wraps

    @wraps(function)
    def run(
        deployment: str | None, include: tuple[str, ...], storm: str, timeout: float, ice_config: str | None, **own: Any
    ) -> None:
        from robocomp_yaml.api.addresses import Addresses
        from robocomp_yaml.api.topics import Topics

        function(Topics(Addresses(deployment or "", include), storm, ice_config or "", timeout), **own)

    options = (_talking.deployment, _storm, _talking.timeout, _talking.ice_config, _options.include)
    return _options.together(*options, _options.text_or_json)(run)


arriving_options = _options.together(count_option, _talking.ending, type_option, with_topics)


@click.group(cls=CommandGroup, short_help="The topics of a running network: list, echo, hz, pub.")
def command() -> None:
    """Show who publishes and subscribes to topics, print messages as they come, measure their rate, and publish.

    A TOPIC has the name that it has in IceStorm, which is usually that of the interface.
    """


@command.command("list", short_help="Print the topics, and who publishes and subscribes.")
@with_topics
@click.pass_context
def list_(ctx: click.Context, topics: Topics, format_: str) -> None:
    """Print every topic with those that publish and subscribe to it by the documents, and how many subscribe to it now.
    Exit code 1: an IceStorm does not answer."""

    known, failures = topics.known()
    if format_ == "json":
        terminal.data(_talking.as_json({"topics": [_as_data(one) for one in known]}, line=False), json=True)
    elif known:
        rows = [("TOPIC", "CARRIES", "PUBLISHED BY", "SUBSCRIBED BY", "NOW")]
        rows += [
            (one.name, one.type or "-", ", ".join(one.publishers) or "-", ", ".join(one.subscribers) or "-", _now(one))
            for one in known
        ]
        terminal.say(*terminal.table(rows))
    elif not failures:
        terminal.say("no topics")
    for failure in failures:
        terminal.say(f"Error: {failure}", err=True)
    ctx.exit(1 if failures else 0)


def _now(topic: KnownTopic) -> str:
    if topic.subscribed is None:
        return "-"
    return f"{topic.subscribed} subscriber{'' if topic.subscribed == 1 else 's'}"


def _as_data(topic: KnownTopic) -> dict[str, Any]:
    return {
        "topic": topic.name, "carries": topic.type or None, "storm": topic.storm, "publishers": list(topic.publishers),
        "subscribers": list(topic.subscribers), "subscribed": topic.subscribed,
    }  # fmt: skip


@command.command(short_help="Print messages as they come.")
@click.argument("names", nargs=-1, required=True, metavar="TOPIC...",
                shell_complete=_talking.completing(topic_names))  # fmt: skip
@arriving_options
def echo(
    topics: Topics, names: tuple[str, ...], count: int | None, duration: float | None, type_: str, format_: str
) -> None:
    """Print the messages of TOPICs as they come, until Ctrl-C. TOPIC.MESSAGE means only this one."""

    def show(messages: Sequence[Message]) -> None:
        if format_ == "json":
            terminal.data("".join(_talking.as_json(one.data) for one in messages), json=True)
        else:
            terminal.say(*(_line(one) for one in messages))

    with arriving_messages(topics, [topics.find(name, type_) for name in names], duration) as arriving:
        arriving.show(show, count)


@command.command(short_help="Measure the rate and the jitter of messages.")
@click.argument("name", metavar="TOPIC", shell_complete=_talking.completing(topic_names))
@click.option("--every", type=Duration(), default="1s", show_default=True, metavar="TIME", help="Time between lines.")
@arriving_options
def hz(
    topics: Topics, name: str, every: float, count: int | None, duration: float | None, type_: str, format_: str
) -> None:
    """Print how many messages of a TOPIC come in a second, the times between them, and how much these vary (their
    standard deviation), until Ctrl-C. TOPIC.MESSAGE means only this one."""
    from robocomp_yaml.api.topics import Rate

    rate = Rate()
    with arriving_messages(topics, [topics.find(name, type_)], duration) as arriving:
        at = time.monotonic()
        while arriving.may_continue and (count is None or rate.total < count):
            at += every
            left = None if count is None else count - rate.total
            rate.add(one.clock for one in arriving.until(at, left))
            report = rate.report()
            if format_ == "json":
                terminal.data(_talking.as_json(report), json=True)
            else:
                terminal.say(_rate(report))


def _rate(report: Any) -> str:
    if report["mean"] is None:
        return f"no messages ({report['messages']} in all)"
    return (
        f"{report['rate']:.1f}/s   every {report['mean']:.2f} ms (from {report['min']:.2f} to {report['max']:.2f})   "
        f"jitter {report['jitter']:.2f} ms   {report['messages']} messages"
    )


@command.command(
    short_help="Publish one message, or many at a rate.", context_settings={"ignore_unknown_options": True}
)
@click.argument("name", metavar="TOPIC.MESSAGE", shell_complete=_talking.completing(_message_names))
@click.argument("arguments", nargs=-1, metavar="[NAME=VALUE]...")
@click.option("--rate", type=click.FloatRange(0, min_open=True), metavar="N", help="N messages per second.")
@click.option(
    "--count", type=click.IntRange(1), metavar="N", help="N messages; by default 1, with --rate until Ctrl-C."
)
@type_option
@with_topics
@click.pass_context
def pub(
    ctx: click.Context, topics: Topics, name: str, arguments: tuple[str, ...], rate: float | None, count: int | None,
    type_: str, format_: str,
) -> None:  # fmt: skip
    """Publish a message. Arguments are those of `rcyaml call`: width=2.5, '{width: 2.5}', or - for standard input."""

    topic, method = topics.find(name, type_)
    _talking.reject_options(ctx, arguments, topic.inputs(method))
    stdin = _talking.standard_input() if "-" in arguments else None
    message = topics.message(topic, method, arguments, stdin)
    sent = 0
    try:
        with topics.publisher(topic) as publisher:
            for _ in _talking.times(count if count or rate else 1, 1 / rate if rate else None):
                publisher.send(message)
                sent += 1
    finally:
        if format_ == "json":
            terminal.data(
                _talking.as_json({"topic": topic.name, "method": message.operation.name, "sent": sent}, line=False),
                json=True,
            )
        elif ctx.obj.verbosity >= 0:
            what = f"{topic.name}.{message.operation.name}"
            terminal.say(f"published {what}" + ("" if sent == 1 else f" {sent} times"), err=True)


def _line(message: Message) -> str:
    from robocomp_yaml.source.yaml_text import flow

    at = time.strftime("%H:%M:%S", time.localtime(message.time))
    arguments = ", ".join(f"{name}: {flow(value)}" for name, value in message.arguments.items())
    return f"{at}.{int(message.time * 1000) % 1000:03d} {message.topic.name}.{message.operation.name}({arguments})"
