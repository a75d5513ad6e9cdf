"""`rcyaml deploy push`: its calls of the library, and its output."""

from __future__ import annotations

from robocomp_yaml.api import pushing
from robocomp_yaml.commands._deploying import DeploySession
from robocomp_yaml.commands._progress import LiveLines
from robocomp_yaml.deploy.json_data import push_data
from robocomp_yaml.deploy.push.planned import HostPush
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.diagnostic import has_errors
from robocomp_yaml.diag.listing import some


def push(session: DeploySession, names: tuple[str, ...], *, dry_run: bool) -> None:
    """Pushes the files, and ends the command."""
    sent: dict[str, int] = {}

    def work() -> list[HostPush]:
        with LiveLines(session.prints_progress) as lines:

            def report(host: str, path: str) -> None:
                sent[host] = sent.get(host, 0) + 1
                lines.draw([f"{name}: {count} files sent" for name, count in sent.items()])

            return pushing.push(session.deployment, names, dry_run=dry_run, report=report)

    done = session.run(work, "interrupted: the next push continues")
    if session.format_ == "json":
        session.end({"dry_run": dry_run, "hosts": [push_data(one) for one in done]})
    if session.prints_progress or dry_run:
        terminal.say(*(line for one in done for line in _lines(one, dry_run, len(max(done, key=_width).host.name))))
        if not done and not has_errors(session.deployment.diagnostics):
            terminal.say(f"{session.network.name}: all processes run on this machine: nothing to push")
    session.end()


def _width(one: HostPush) -> int:
    return len(one.host.name)


def _lines(one: HostPush, dry_run: bool, width: int) -> list[str]:
    name = one.host.name.ljust(width)
    send, delete = ("would send", "would delete") if dry_run else ("sent", "deleted")
    lines = []
    if one.is_empty:
        lines.append(f"{name}  nothing to send, {one.unchanged} files are up to date")
    if one.send:
        lines.append(f"{name}  {send} {_count(len(one.send))}, {_size(one.size)}; {one.unchanged} are up to date")
    if dry_run:
        lines += [f"{name}  + {path}" for path in sorted(one.send)] + [
            f"{name}  - {path}" for path in sorted(one.delete)
        ]
    elif one.delete:
        lines.append(f"{name}  {delete} {_count(len(one.delete))} that nothing needs any more")
    if one.replaced:
        what = "would replace" if dry_run else "replaced"
        lines.append(
            f"{name}  {what} what no push had brought, or was changed there (kept in {one.kept}): "
            f"{some(sorted(one.replaced), 5)}"
        )
    if one.changed:
        lines.append(
            f"{name}  nothing needs these any more; they stay, because they were changed there: "
            f"{some(sorted(one.changed), 5)}"
        )
    if one.built:
        lines.append(f"{name}  kept {', '.join(sorted(one.built))}: built there")
    return lines


def _count(number: int) -> str:
    return f"{number} file{'s' * (number != 1)}"


def _size(number: int) -> str:
    return (
        f"{number} bytes"
        if number < 1 << 10
        else f"{number / 1024:.0f} KiB"
        if number < 1 << 20
        else f"{number / (1 << 20):.1f} MiB"
    )
