"""What users read where the wrong example of each diagnostic is checked: the text that is meant, the words, the hint."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import groupby

from in_memory import said
from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import table
from robocomp_yaml.diag.page import Files

NOT_BUILT = ("RC4403", "RC4404")


def in_memory(files: Files) -> dict[str, str]:
    """The texts among the files of an example: what is built is only a link, and is on no disk."""
    return {path: it for path, it in files.items() if isinstance(it, str) and not it.startswith("-> ")}


def shown(row: Code) -> str:
    """'' where it takes more than a check of texts."""
    command, *asked = row.command.split()
    documents = in_memory(row.wrong)
    if command != "check" or not set(asked) <= {".", *documents}:
        return ""
    found = said(documents, *(name for name in asked if name != "."))
    lines = []
    for one in found if row.id in {one.code for one in found} else ():
        if one.code == row.id or one.code not in NOT_BUILT:
            at = one.at if one.at.count("\n") < 2 and len(one.at) < 100 else f"{one.at.splitlines()[0][:50]} …"
            lines += [f"{one.code} in {one.file}, at `{at}`:", f"  {one.message}"]
            lines += [f"  hint: {one.hint}"] if one.hint else []
            lines += [f"  {text}: `{place}`" for text, place in one.related]
    return "\n".join([*lines, ""]) if lines else ""


def test_the_wrong_examples(golden: Callable[[str, Mapping[str, str]], None]) -> None:
    rows = [(row.id, shown(row)) for row in table().values()]
    assert sum(bool(text) for _, text in rows) > len(rows) / 2
    families = groupby(rows, key=lambda row: row[0].rstrip("0123456789") + row[0][-4:-2])
    texts = {f"{name}xx.txt": "\n".join(text for _, text in some if text) for name, some in families}
    golden("said", {name: text for name, text in texts.items() if text})
