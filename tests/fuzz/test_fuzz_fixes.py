"""Documents changed at random, fixed: no fix stumbles, takes a comment away or makes a document worse, and comments that
allow something are told what is wrong with them."""

from __future__ import annotations

import json
import re
from pathlib import Path

from hypothesis import example, given
from hypothesis import strategies as st

from conftest import Tree
from documents_of_rows import DOCUMENTS
from fuzzing import as_bytes, changed, examples, is_in_its_file, run, standing_in, told

ALLOW = (
    "# rcyaml: allow RC1104 -- so\n", "  # rcyaml: allow RC2103, RC2007\n", " # rcyaml: allow RC2003 -- x", "# rcyaml:",
    " # rcyaml: allow", "# rcyaml allow RC1006 ", " #rcyaml:allow,rc0060,,RC9999 -- ", "# rcyaml: allow RC0063 RC0062 so\n",
)  # fmt: skip
FAULTS = (
    "Module",
    "Imports",
    "Speach",
    "@",
    "yes",
    "strng",
    "'5'",
    "5",
    "Speech, Speech",
    "implement",
    "doc: a: b\n",
    "true",
)


TREES = [files for files in DOCUMENTS if any(isinstance(text, str) for text in files.values())]


@st.composite
def faulty(draw: st.DrawFn) -> Tree:
    files = draw(st.sampled_from(TREES))
    name = draw(st.sampled_from(sorted(name for name, text in files.items() if isinstance(text, str))))
    return {**files, name: as_bytes(draw(changed(str(files[name]), ALLOW + FAULTS)))}


def comments(path: Path) -> int:
    lines = re.split("\r\n|\r|\n", path.read_bytes().decode("utf-8", "replace"))
    return sum(line.lstrip(" \t").startswith("#") and "rcyaml" not in line for line in lines)


def levels(found: list[dict[str, object]]) -> set[object]:
    """The documents that could not be understood as they stand."""
    return {
        each["file"]
        for each in found
        if str(each["code"])[:4] in ("RC00", "RC01", "RC02") and each["severity"] == "error"
    }


@example({"M.idsl.yaml": "module: M  # rcyaml: allow RC1006 -- x\r# a\rimports: [M, M]\r"})
@given(faulty())
@examples(120)
def test_fixes(files: Tree) -> None:
    with standing_in(files) as folder:
        documents = sorted(folder.rglob("*.yaml"))
        before = {path: path.read_bytes() for path in documents}
        counts = {path: comments(path) for path in documents}
        _, found = told("check", ".")
        for each in found:
            for fix in each["fixes"]:
                assert fix["edits"], each
                for edit in fix["edits"]:
                    is_in_its_file(edit)
        run("check", "--unsafe-fixes", "--diff")
        assert {path: path.read_bytes() for path in documents} == before
        for option in ("--fix", "--unsafe-fixes"):
            data = json.loads(run("check", option, "--format", "json").stdout)
            written = {folder / one["path"] for one in data["files"]}
            assert all(path in written or path.read_bytes() == before[path] for path in documents) or option != "--fix"
            assert all(comments(path) >= counts[path] for path in documents)
            errors = [sum(each["severity"] == "error" for each in some) for some in (found, data["diagnostics"])]
            assert errors[1] <= errors[0] or levels(found), (found, data)
            assert levels(data["diagnostics"]) <= levels(found) | {each["file"] for each in found}
            found = data["diagnostics"]
