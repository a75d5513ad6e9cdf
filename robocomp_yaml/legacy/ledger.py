"""The ledger: the outcome of every line of every file, and the totals."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import msgspec

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import ERROR, WARNING, Diagnostic
from robocomp_yaml.diag.render.json import as_data, dumps
from robocomp_yaml.legacy.convert import Converted
from robocomp_yaml.legacy.sources import LegacyFile

CONVERTED, WARNED, REFUSED, SKIPPED = "converted", "warned", "refused", "skipped"
STATUSES = (CONVERTED, WARNED, REFUSED, SKIPPED)
CLASSES = ("blank", "converted", "comment", "repaired", "lost", "refused")

_REPAIRS = {codes.REPAIRED.id: "repaired", codes.OVERLOAD.id: "repaired", codes.LOST.id: "lost"}


class LedgerEntry(msgspec.Struct):
    """The outcome of one file. `skipped`: its document is kept as it is, on purpose. `blocked`: it could not be
    written."""

    legacy: LegacyFile
    file: Converted
    outputs: list[str] = []
    diagnostics: list[Diagnostic] = []
    skipped: bool = False
    blocked: bool = False

    @property
    def status(self) -> str:
        severities = {diagnostic.severity for diagnostic in self.diagnostics}
        if (self.file.refused and not self.skipped) or self.blocked or ERROR in severities:
            return REFUSED
        if self.skipped:
            return SKIPPED
        return WARNED if WARNING in severities else CONVERTED

    @property
    def format(self) -> str:
        return self.file.rules.title if self.file.rules is not None else "unknown"

    def lines(self) -> Counter[str]:
        """Return the number of lines of each class. Their sum is the number of the file's lines."""
        source, parsed = self.file.source, self.file.parsed
        texts = source.text.split("\n")[: source.lines] if source is not None else []
        if source is None or self.status == REFUSED or parsed is None or parsed.tree is None:
            return Counter("refused" if text.strip() else "blank" for text in texts)
        bare = list(source.text)
        commented: set[int] = set()
        for token in parsed.comments:
            start, end = token.start_pos or 0, token.end_pos or 0
            bare[start:end] = [char if char == "\n" else " " for char in bare[start:end]]
            commented.update(range(source.line(start), source.line(end) + 1))
        classes = []
        for number, text in enumerate("".join(bare).split("\n")[: source.lines], 1):
            classes.append("converted" if text.strip() else "comment" if number in commented else "blank")
        for diagnostic in self.diagnostics:
            line = diagnostic.span.line - 1
            if diagnostic.code in _REPAIRS and classes[line] in ("converted", "repaired"):
                classes[line] = _REPAIRS[diagnostic.code]
        return Counter(classes)


def as_json(entries: Sequence[LedgerEntry]) -> str:
    """Return the text of `--report`."""
    totals: dict[str, object] = {"files": len(entries)}
    totals |= {status: sum(entry.status == status for entry in entries) for status in STATUSES}
    lines: Counter[str] = Counter()
    files = []
    for entry in entries:
        classes = entry.lines()
        lines += classes
        files.append(
            {
                "source": entry.file.path,
                "format": entry.file.rules.name if entry.file.rules is not None else None,
                "status": entry.status,
                "outputs": entry.outputs,
                "lines": _counts(classes),
                "diagnostics": [as_data(diagnostic) for diagnostic in entry.diagnostics],
            }
        )
    totals["lines"] = _counts(lines)
    return dumps({"files": files, "totals": totals})


def _counts(lines: Counter[str]) -> dict[str, int]:
    return {"total": lines.total(), **{name: lines[name] for name in CLASSES}}
