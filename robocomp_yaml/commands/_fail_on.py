"""`--fail-on`: which diagnostics besides errors make a run fail: those of a severity and worse, or of a code."""

from __future__ import annotations

from collections.abc import Iterable

import click
import msgspec

from robocomp_yaml.commands import _plugged
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.diagnostic import ERROR, SEVERITIES, Diagnostic


class FailOn(msgspec.Struct, frozen=True):
    """`severity` is the least that fails a run, `codes` fail it whatever their severity is. `text` is as given."""

    severity: str = ERROR
    codes: frozenset[str] = frozenset()
    text: str = ""

    def code(self, told: Iterable[Diagnostic]) -> int:
        """The exit code of a run that has told this."""
        return 1 if any(self._counts(one) for one in told) else 0

    def explain(self, told: Iterable[Diagnostic]) -> None:
        """Says why a run fails that has no errors."""
        counting = [one for one in told if self._counts(one)]
        if counting and all(one.severity != ERROR for one in counting):
            codes = ", ".join(sorted({one.code for one in counting}))
            terminal.say(f"this fails because of {codes} (--fail-on {self.text})", err=True)

    def _counts(self, one: Diagnostic) -> bool:
        worst = SEVERITIES.index(one.severity)  # they are in order, the worst first
        return worst <= SEVERITIES.index(self.severity) or one.code in self.codes


ERRORS = FailOn()


def _parse(ctx: click.Context, param: click.Parameter, given: tuple[str, ...]) -> FailOn:
    words = [word.strip() for text in given for word in text.split(",")]
    severities = [word.lower() for word in words if word.lower() in SEVERITIES]
    codes = [word.upper() for word in words if word.lower() not in SEVERITIES]
    if codes:
        from robocomp_yaml.diag.codes import table
        from robocomp_yaml.diag.suggest import suggest

        known = dict(table())
        if any(code not in known for code in codes):
            known |= _plugged.codes(ctx)
        for code in codes:
            if code not in known:
                meant = suggest(code.lower(), SEVERITIES) or suggest(code, known)
                hint = f"did you mean '{meant}'?" if meant else "`rcyaml explain` lists the codes"
                word = next(word for word in words if word.upper() == code)
                severity = f"{', '.join(SEVERITIES[:-1])} or {SEVERITIES[-1]}"
                raise click.BadParameter(f"'{word}' is neither {severity} nor the code of a diagnostic; {hint}")
    least = max(severities, key=SEVERITIES.index, default=ERROR)
    return FailOn(least, frozenset(codes), ",".join(words))


fail_on = click.option(
    "--fail-on", "fail_on", multiple=True, metavar="WHAT", callback=_parse,
    help="Exit with 1 for these too: warning, note, or codes such as RC2007,RC3107; may be repeated.",
)  # fmt: skip
