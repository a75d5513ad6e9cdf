"""The commands of `rcyaml deploy`: calls of the library, and their output."""

from __future__ import annotations

import asyncio
import os
import shutil
import signal
import sys
from collections.abc import Callable, Iterable
from typing import NoReturn, TypeVar

import click
import msgspec

from robocomp_yaml import api
from robocomp_yaml.api import which
from robocomp_yaml.commands import _deploy_views as views
from robocomp_yaml.commands import _options, _signals
from robocomp_yaml.commands._progress import Progress
from robocomp_yaml.deploy import json_data, renamed
from robocomp_yaml.deploy.differences import shown_path
from robocomp_yaml.deploy.engine import Line
from robocomp_yaml.deploy.operations import Choose, Result, reasons_to_stop
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.diag.errors import Faulty
from robocomp_yaml.diag.render.json import as_data, dumps
from robocomp_yaml.network.network import Network

T = TypeVar("T")
Names = tuple[str, ...]


def open_session(
    ctx: click.Context, ddsl: str, include: tuple[str, ...], format_: str, engine: str | None, *, lenient: bool
) -> DeploySession:  # fmt: skip
    """Reads the document with all that it refers to, and opens its deployment. Ends the command if the document has
    errors. `lenient` accepts errors that leave the network readable; if they do not, the network is that of the running
    processes, so that these can always be stopped."""
    path = os.path.normpath(which.deployment(ddsl, include))
    try:
        deployment = api.load(path, include=include).deployment(path, engine=engine, lenient=lenient)
    except Faulty as faulty:
        _options.report(ctx, format_, faulty.diagnostics, faulty.documents or 0)
    if deployment.unread:
        why = "cannot be read (see `rcyaml check`)" if os.path.exists(path) else "is gone"
        if os.path.isdir(path):  # the own folder of a running deployment
            path, why = shown_path(deployment.network.path), "describes another deployment now"
        terminal.say(f"{path} {why}: the running processes are used instead", err=True)
    if found := renamed.at_another_path(deployment.network):
        terminal.say(found, err=True)
    return DeploySession(ctx, deployment, format_)


class DeploySession(msgspec.Struct):
    """A deployment, as a command uses it. `shown` are the diagnostics that are printed already; `ended_by` is the exit
    code if the user ended an attached deployment. All methods but `build` end the command."""

    ctx: click.Context
    deployment: api.Deployment
    format_: str
    shown: list[Diagnostic] = []
    ended_by: int = 0

    @property
    def network(self) -> Network:
        return self.deployment.network

    @property
    def _color(self) -> bool:
        return _options.colored(self.ctx)

    @property
    def prints_progress(self) -> bool:
        return self.format_ == "text" and self.ctx.obj.verbosity >= 0

    def plan(self, names: Names, *, restart: bool = False) -> NoReturn:
        found = self.run(lambda: self.deployment.plan(*names, restart=restart))
        if self.format_ == "json":
            self.end({"plan": views.plan_data(found, self.network)})
        terminal.say(*views.plan_lines(found, self.network, self._color, everything=self.ctx.obj.verbosity > 0))
        self.end()

    def build(self, names: Names) -> None:
        """Ends the command if a component cannot be built. Then nothing is started."""
        from robocomp_yaml.commands import build

        built = build.run(
            self.ctx, self.format_, lambda report: self.deployment.build(*names, report=report),
            "interrupted: nothing was started; what was built stays",
        )  # fmt: skip
        if any(one.has_errors for one in built):
            if self.format_ == "json":
                self._print_json({}, [one for each in built for one in each.diagnostics])
            else:
                terminal.say(f"{self.network.name}: nothing was changed")
            self.ctx.exit(1)

    def up(
        self, names: Names, on_failure: str, timeout: float | None, *, restart: bool = False, attach: bool = False
    ) -> None:  # fmt: skip
        def start(progress: Progress, decide: str | Choose) -> Result:
            return self.deployment.up(
                *names, restart=restart, timeout=timeout, report=progress.report, on_failure=decide,
                stays=self._attached(progress) if attach else None,
            )  # fmt: skip

        self._change(start, on_failure, "interrupted: all processes were stopped" if attach else None, shows=not attach)

    def rollback(self, on_failure: str, timeout: float | None) -> None:
        def start(progress: Progress, decide: str | Choose) -> Result:
            return self.deployment.rollback(timeout=timeout, report=progress.report, on_failure=decide)

        self._change(start, on_failure)

    def _change(
        self, work: Callable[[Progress, str | Choose], Result], on_failure: str, on_interrupt: str | None = None, *,
        shows: bool = True,
    ) -> None:  # fmt: skip
        """Changes what runs, with progress; a user is asked about failures on a terminal."""
        asks_user = on_failure == "ask" and sys.stdin.isatty() and sys.stdout.isatty() and self.format_ == "text"
        progress = self._progress()

        async def choose(result: Result) -> str:
            progress.pause()
            self._show(self.deployment.placed(result.diagnostics))
            return await _options.ask(
                "stop what was started, roll back to what ran before, or keep it as it is?",
                ("stop", "rollback", "keep"),
            )

        def start() -> Result:
            with progress:
                return work(progress, choose if asks_user else "stop" if on_failure == "ask" else on_failure)

        result = self.run(start, on_interrupt)
        self._say_installed("at boot, as it is left now")
        if self.format_ == "json":
            self.end(json_data.result_data(result))
        if shows and self.prints_progress:
            terminal.say(views.result_text(self.network, result))
        self.end()

    def _attached(self, progress: Progress) -> api.Attached:
        """The user who watches the output, and ends the deployment by Ctrl-C."""
        view = views.LogView(self.deployment.enabled, self._color, times=False)

        def on_line(line: Line) -> None:
            terminal.say(view.text(line))

        def on_up(enough: asyncio.Event) -> None:
            def stop(number: int) -> None:
                self.ended_by = 128 + number
                enough.set()

            progress.pause()
            for number in (signal.SIGINT, signal.SIGTERM):
                asyncio.get_running_loop().add_signal_handler(number, stop, number)
            if self.prints_progress:
                terminal.say(f"{self.network.name}: Ctrl-C stops it")

        return api.Attached(on_up, on_line if self.format_ == "text" else None)

    def status(self, names: Names) -> None:
        if running := renamed.under_another_name(self.network):
            terminal.say(running, err=True)
        found = self.run(lambda: self.deployment.status(*names))
        code = 0 if all(one.is_as_desired for one in found) and not self.deployment.was_killed else 1
        if self.format_ == "json":
            self.end(
                {"processes": json_data.status_data(self.network, found), "installed": self.deployment.installed}, code
            )
        room = shutil.get_terminal_size().columns if sys.stdout.isatty() else None
        terminal.say(*views.status_lines(self.network, found, self._color, room))
        self._say_installed("at boot")
        if lost := views.lost_lines(found):
            terminal.say(*lost, err=True)
        self.end(code=code)

    def logs(self, names: Names, last: int | None, *, follow: bool, times: bool, since: str, pattern: str) -> None:
        chosen = self.deployment.chosen(names) or self.deployment.enabled
        view = views.LogView(chosen, self._color, times)

        def on_line(line: Line) -> None:
            if self.format_ == "json":
                terminal.data(views.line_data(line), json=True)
            else:
                terminal.say(view.text(line))

        self.run(
            lambda: self.deployment.logs(
                *names, last=last, follow=follow, on_line=on_line, since=since, pattern=pattern
            ),
            on_interrupt="",
        )  # fmt: skip

    def down(self, names: Names, *, dry_run: bool) -> None:
        if dry_run:
            self._stopping(names)

        def stop_all() -> list[str]:
            with self._progress() as progress:
                return self.deployment.down(*names, report=progress.report)

        stopped = self.run(stop_all)
        self._say_installed("again at the next boot, until `rcyaml deploy uninstall`")
        if self.format_ == "json":
            self.end({"stopped": stopped})
        if not stopped:
            chosen = self.deployment.chosen(names)  # others may run
            named = ", ".join(name for name in self.network.processes if name in chosen)
            which = f"{named} {'was' if len(chosen) == 1 else 'were'} not" if chosen else "nothing was"
            terminal.say(f"{self.network.name}: {which} running")
        self.end()

    def _stopping(self, names: Names) -> NoReturn:
        """Ends the command with what `down` would stop."""
        stopping = self.run(lambda: self.deployment.stopping(*names))
        reasons = reasons_to_stop(self.network, stopping, self.deployment.chosen(names))
        if self.format_ == "json":
            self.end({"stop": stopping, "reasons": reasons})
        terminal.say(*views.stop_lines(stopping, reasons, self._color))
        self.end()

    def _say_installed(self, when: str) -> None:
        hosts = self.deployment.installed
        if hosts and self.prints_progress:
            terminal.say(f"{self.network.name} is installed on {', '.join(hosts)}: systemd starts it {when}", err=True)

    def probe(self, name: str = "") -> None:
        """Probes a host, or all hosts. The exit code is 1 if one of them cannot run its programs."""
        from robocomp_yaml.deploy.probe import can_run

        answers = self.deployment.probe(name)
        code = 0 if all(can_run(self.network, host, found) for host, found in answers.items()) else 1
        if self.format_ == "json":
            self.end({"hosts": msgspec.to_builtins(answers)}, code)
        for host, found in answers.items():
            address = self.network.hosts[host].address
            head = host if address == host else f"{host} ({address})"
            terminal.say(f"{head}:", *views.probe_lines(found, self._color))
        self.end(code=code)

    def export(self, form: str, output: str | None) -> None:
        """Prints the files, or writes them below `output`. They may contain secrets, which are hidden on a terminal."""
        if output is None:
            before = len(self.deployment.diagnostics)
            files = self.run(lambda: self.deployment.export(form, reveal=not sys.stdout.isatty()))
            if self.format_ == "json":
                terminal.data(dumps({"files": files}), json=True)
            else:
                _print_files(files)
            self._show(self.deployment.diagnostics[before:])
            return
        written = self.run(lambda: self.deployment.write_export(form, output))
        if self.format_ == "json":
            self.end({"written": written})
        if self.prints_progress:
            terminal.say(*(f"wrote {path}" for path in written))
        self.end()

    def _progress(self) -> Progress:
        return Progress(self.prints_progress, self._color, self.deployment.enabled)

    def run(self, work: Callable[[], T], on_interrupt: str | None = None) -> T:
        """The result of a call of the library. Errors end the command, and so does Ctrl-C, with a line about the
        running processes."""
        try:
            return work()
        except Faulty:
            self.end()
        except KeyboardInterrupt as error:
            if on_interrupt is None:
                stop = terminal.typed("rcyaml", "deploy", "down", self.deployment.path)
                on_interrupt = f"interrupted: running processes keep running; `{stop}` stops them"
            if on_interrupt and self.format_ == "json":
                self._print_json({"interrupted": on_interrupt}, self.deployment.diagnostics)
            elif on_interrupt:
                terminal.say(on_interrupt, err=True)
            self.ctx.exit(_signals.code_of(error))

    def end(self, data: dict[str, object] | None = None, code: int = 0) -> NoReturn:
        """Prints the diagnostics, and ends the command: with 1 if one is an error, else with `code`."""
        diagnostics = self.deployment.diagnostics
        if self.format_ == "json":
            self._print_json(data or {}, diagnostics)
        else:
            self._show(diagnostics)
        self.ctx.exit(self.ended_by or (1 if has_errors(diagnostics) else code))

    def _print_json(self, data: dict[str, object], diagnostics: Iterable[Diagnostic]) -> None:
        head = {"deployment": self.network.name, "engine": self.deployment.engine, **data}
        terminal.data(dumps({**head, "diagnostics": [as_data(one) for one in diagnostics]}), json=True)

    def _show(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Prints the diagnostics that are not printed yet."""
        new = [one for one in diagnostics if one not in self.shown]
        self.shown += new
        if new:
            from robocomp_yaml.diag.render import text

            blocks = text.each(new, _options.colored(self.ctx, sys.stderr))
            terminal.say(*[line for block in blocks for line in (terminal.Shown(), *block)][1:], err=True)


def _print_files(files: dict[str, str]) -> None:
    for path, content in files.items():
        if len(files) > 1:
            terminal.data(f"# {path}\n")
        terminal.data(content if content.endswith("\n") else f"{content}\n")
