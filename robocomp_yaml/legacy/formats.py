"""Detect the legacy format of a file: by its content, and by its name where the content is not sufficient."""

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
    """Return the format of a file's suffix; None where the suffix is of no format, or of many."""
    return next((rules for rules in known if not rules.by_content and _has_suffix(path, rules)), None)


def _has_suffix(path: str, rules: Rules) -> bool:
    return os.path.splitext(path)[1].lower() in rules.suffixes


def recognize(source: SourceText, known: Formats | None = None) -> tuple[Rules | None, list[Diagnostic]]:
    """Return the format of a text, one of the known formats (by default the built-in ones); None and the reason where
    it has none of them."""
    known = formats() if known is None else known
    by_suffix = by_name(source.path, known)
    content = without_silent(source.text)
    if not content.strip():
        what = "only comments" if source.text.strip() else "no text"
        return None, [codes.EMPTY.at(Span(source.path), what=what)]
    fitting = [
        rules for rules in known
        if (not rules.weak or _may_be(rules, by_suffix)) and rules.signature.search(content)
    ]  # fmt: skip
    if by_suffix is not None and (by_suffix in fitting or not fitting):
        return _unless_foreign(by_suffix, source)
    if not fitting:
        listed = ", ".join(f"{rules.title} ({', '.join(rules.suffixes)})" for rules in known)
        return None, [codes.UNKNOWN_FORMAT.at(Span(source.path), formats=listed)]
    detected = fitting[0]
    if by_suffix is None or by_suffix.weak:
        return _unless_foreign(detected, source)
    return detected, [codes.OTHER_FORMAT.at(Span(source.path), said=by_suffix.title, found=detected.title)]


def _may_be(rules: Rules, by_suffix: Rules | None) -> bool:
    """Whether a weak signature overrides the format of the suffix: a `.conf` may be TOML."""
    return by_suffix is None or by_suffix is rules or (by_suffix.kind == rules.kind and rules.rank < by_suffix.rank)


def _unless_foreign(rules: Rules, source: SourceText) -> tuple[Rules | None, list[Diagnostic]]:
    """Return None, with the reason, where a text has the marks of another program's file."""
    if rules.weak and not os.path.basename(source.path).isprintable():
        reason = "the name of this file is not valid text, so that no document can refer to it; rename the file"
        return None, [codes.REFUSED.at(Span(source.path), reason=reason)]
    for foreign in rules.foreign:
        if match := foreign.pattern.search(source.text):
            mark = source.text[match.start() : match.end()]
            at = match.start() + len(mark) - len(mark.lstrip())
            return None, [codes.REFUSED.at(source.span(at, max(match.end(), at + 1)), reason=foreign.reason)]
    if rules.invalid:
        entries = properties.read(source.text)
        count, all_ = len(entries.invalid), len(entries.entries) + len(entries.invalid)
        if all_ and (count / all_ > rules.invalid["share"] or not entries.entries):
            line = entries.invalid[0]
            reason = rules.invalid["reason"].format(count=count, all=all_, line=line)
            location = Span(source.path, line, 1, line, len(source.line_text(line)) + 1)
            return None, [codes.REFUSED.at(location, reason=reason)]
    return rules, []


def is_legacy_file(path: str, known: Formats) -> bool:
    """Whether a file in a folder is a legacy file: by its name, or by its content where the name is ambiguous."""
    by_suffix = by_name(path, known)
    if by_suffix is not None and not by_suffix.keep_suffix:
        return True
    fits = {rules.files.fit(path) for rules in known if rules.files is not None}
    if "certain" in fits:
        return True
    has_suffix = any(rules.by_content and _has_suffix(path, rules) for rules in known)
    if "perhaps" not in fits and not has_suffix:
        return False
    source, _ = read(path)
    detected = recognize(source, known)[0] if source is not None else None
    return detected is not None and ("perhaps" in fits or detected.by_content)
