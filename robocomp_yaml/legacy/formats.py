"""Which legacy format a file is in: told by its content, and by its name where the content does not tell."""

from __future__ import annotations

import os

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.legacy.reading import SourceText, read
from robocomp_yaml.legacy.rules import Formats, Rules, formats
from robocomp_yaml.legacy.syntax_error import without_silent
from robocomp_yaml.source import properties


def by_name(path: str, known: Formats) -> Rules | None:
    """The format that a file's suffix says."""
    return next((rules for rules in known if not rules.by_content and _has_suffix(path, rules)), None)


def _has_suffix(path: str, rules: Rules) -> bool:
    return os.path.splitext(path)[1].lower() in rules.suffixes


def recognize(source: SourceText, known: Formats | None = None) -> tuple[Rules | None, list[Diagnostic]]:
    """Which of the known formats, by default the built-in ones, a text is in; None with the reason where it is in
    none."""
    known = formats() if known is None else known
    said = by_name(source.path, known)
    content = without_silent(source.text)
    if not content.strip():
        what = "nothing but comments" if source.text.strip() else "nothing"
        return None, [codes.EMPTY.at(Span(source.path), what=what)]
    fitting = [
        rules for rules in known
        if (not rules.weak or _may_be(rules, said)) and rules.signature.search(content)
    ]  # fmt: skip
    if said is not None and (said in fitting or not fitting):
        return _unless_foreign(said, source)
    if not fitting:
        listed = ", ".join(f"{rules.title} ({', '.join(rules.suffixes)})" for rules in known)
        return None, [codes.UNKNOWN_FORMAT.at(Span(source.path), formats=listed)]
    found = fitting[0]
    if said is None or said.weak:
        return _unless_foreign(found, source)
    return found, [codes.OTHER_FORMAT.at(Span(source.path), said=said.title, found=found.title)]


def _may_be(rules: Rules, said: Rules | None) -> bool:
    """Whether a signature that much else fits counts against what the name says: a `.conf` may be TOML."""
    return said is None or said is rules or (said.kind == rules.kind and rules.rank < said.rank)


def _unless_foreign(rules: Rules, source: SourceText) -> tuple[Rules | None, list[Diagnostic]]:
    """Other programs' files look alike: None where one of their marks is in this one."""
    if rules.weak and not os.path.basename(source.path).isprintable():
        reason = "the name of this file is no text, so no document can say it; rename the file"
        return None, [codes.REFUSED.at(Span(source.path), reason=reason)]
    for foreign in rules.foreign:
        if found := foreign.pattern.search(source.text):
            mark = source.text[found.start() : found.end()]
            at = found.start() + len(mark) - len(mark.lstrip())
            return None, [codes.REFUSED.at(source.span(at, max(found.end(), at + 1)), reason=foreign.reason)]
    if rules.invalid:
        entries = properties.read(source.text)
        count, all_ = len(entries.invalid), len(entries.entries) + len(entries.invalid)
        if all_ and (count / all_ > rules.invalid["share"] or not entries.entries):
            line = entries.invalid[0]
            reason = rules.invalid["reason"].format(count=count, all=all_, line=line)
            place = Span(source.path, line, 1, line, len(source.line_text(line)) + 1)
            return None, [codes.REFUSED.at(place, reason=reason)]
    return rules, []


def candidate(path: str, known: Formats) -> bool:
    """Whether a file of a folder is to be migrated: its name says so, or its name may and its content does."""
    said = by_name(path, known)
    if said is not None and not said.keep_suffix:
        return True
    fits = {rules.files.fit(path) for rules in known if rules.files is not None}
    if "certain" in fits:
        return True
    told = any(rules.by_content and _has_suffix(path, rules) for rules in known)
    if "perhaps" not in fits and not told:
        return False
    source, _ = read(path)
    found = recognize(source, known)[0] if source is not None else None
    return found is not None and ("perhaps" in fits or found.by_content)
