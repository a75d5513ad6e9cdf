"""Diagnostics about the user's class: what it lacks, with the text to paste, and what of it is out of date."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from robocomp_yaml.diag.codes import specific as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.emit.specific import entries, sources
from robocomp_yaml.emit.specific.code import CLASS, Code, Method
from robocomp_yaml.emit.specific.compare import Comparison, Lacking, compare
from robocomp_yaml.emit.specific.insert import lead
from robocomp_yaml.emit.specific.own import Own
from robocomp_yaml.emit.specific.reading import comment_mark, is_code, read
from robocomp_yaml.transactions.places import Root


def tell(root: Root, files: Sequence[Own], document: str) -> Iterator[Diagnostic]:
    """All that is to be said of the files of the component that a document describes."""
    merge = f"paste what follows, or let `{typed('rcyaml', 'compile', '--merge', document)}` put it in"
    code = [file for file in files if file.yours is not None and is_code(file.plan.path)]
    if any(not file.is_settled for file in code):
        yield from _about_class(root, code, merge)
    for file in files:
        if entries.is_entries(file.plan.path) and file.yours is not None and not file.is_settled:
            yield from _about_entries(root, file, merge)


def _about_class(root: Root, files: Sequence[Own], merge: str) -> Iterator[Diagnostic]:
    new = [code for file in files if (code := read(file.plan.path, file.plan.text))]
    base = {file.plan.path: code for file in files if file.base and (code := read(file.plan.path, file.base))}
    yours = [code for file in files if (code := read(file.plan.path, file.yours or ""))]
    found = compare(new, base, yours)
    if found.lacking or not any(code.place for code in yours):
        # Parts of the class may stand in other files.
        folders = sorted({file.plan.path.rpartition("/")[0] for file in files})
        known = {file.plan.path for file in files}
        yours += [code for folder in folders for code in sources.others(root, folder, known)]
        found = compare(new, base, yours)
    home = next((code for code in yours if code.place), None)
    if home is None or home.place is None:
        homes = {code.path for code in new if code.place}
        where = next((code for code in yours if code.path in homes), yours[0])
        yield codes.NO_CLASS.at(Span(root.shown(where.path)), name=CLASS, path=root.shown(where.path))
        return
    if found.lacking:
        names = list(dict.fromkeys(one.method.name for one in found.lacking))
        span = Span(root.shown(home.path), home.place.line, home.place.column, home.place.line, home.place.end_column)
        yield codes.LACKING.at(
            span, name=CLASS, methods=", ".join(names), more=_paste(root, found.lacking, yours),
            hint=merge,
        )  # fmt: skip
    yield from _about_methods(root, found)


def _about_methods(root: Root, found: Comparison) -> Iterator[Diagnostic]:
    for one in found.outdated:
        yield codes.OUTDATED.at(
            _span(root, one.code, one.method), name=one.method.name, more=_head(one.skeleton, one.wanted),
            hint="it must begin like this now",
        )  # fmt: skip
    for gone in found.gone:
        first, *rest = gone.places
        yield codes.GONE.at(
            _span(root, *first), name=gone.name,
            related=[Related("it stands here too", _span(root, *place)) for place in rest],
            hint=f"was it renamed to '{gone.renamed}'?" if gone.renamed else "remove it, or keep it as your own",
        )  # fmt: skip


def _about_entries(root: Root, file: Own, merge: str) -> Iterator[Diagnostic]:
    keys = entries.lacking(file.base, file.yours or "", file.plan.text)
    if keys:
        path = root.shown(file.plan.path)
        yield codes.CONFIG_LACKS.at(
            Span(path), path=path, keys=", ".join(keys), more=entries.paste(file.plan.text, keys),
            hint=merge,
        )  # fmt: skip


def _span(root: Root, code: Code, method: Method) -> Span:
    place = method.place
    return Span(root.shown(code.path), place.line, place.column, place.line, place.end_column)


def _paste(root: Root, lacking: Sequence[Lacking], yours: Sequence[Code]) -> str:
    """The text to paste, file by file."""
    parts: list[str] = []
    skeletons = list({one.skeleton.path: one.skeleton for one in lacking}.values())
    mine = {line.strip() for code in yours for line in code.lines}
    for skeleton in skeletons:
        known = {one.key for code in yours if code.path == skeleton.path for one in code.imports}
        parts += [one.line for one in skeleton.imports if one.key not in known]
        if len(skeletons) > 1:
            parts.append(f"{comment_mark(skeleton.path)} in {skeleton.path}:\n")
        for one in lacking:
            if one.skeleton is skeleton:
                title = lead(skeleton, one.method)
                if title and title.splitlines()[0].strip() not in mine and title not in parts:
                    parts.append(title)
                parts.append(skeleton.text_of(one.method) + ("\n" if one.method.has_body else ""))
    return "".join(parts).rstrip("\n")


def _head(skeleton: Code, method: Method) -> str:
    """A method as far as its body."""
    lines = skeleton.lines[method.first : method.end]
    for n, line in enumerate(lines):
        if line.rstrip().endswith((":", ";")) or (n and line.strip() == "{"):
            return "".join(lines[: n if line.strip() == "{" else n + 1]).rstrip("\n")
    return "".join(lines).rstrip("\n")
