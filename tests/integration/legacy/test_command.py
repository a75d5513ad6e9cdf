"""`rcyaml migrate`: what it writes and where, what it never overwrites, and its output."""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import read_tree, write_tree

Run = Callable[..., Result]

SPEECH = "module RoboCompSpeech\n{\n    // says\n    interface Speech { void say(string text); };\n};\n"
SPEECH_YAML = (
    "module: RoboCompSpeech\ninterfaces:\n  # says\n  Speech:\n    methods:\n      say: {in: {text: string}}\n"
)
COMPONENT = (
    'import "/robocomp/interfaces/IDSLs/Speech.idsl";\n'
    "Component SpeechComp { Communications { implements Speech; }; language python; };\n"
)
TREE = {"interfaces/Speech.idsl": SPEECH, "components/speech/speech.cdsl": COMPONENT}


def _documents(folder: Path) -> dict[str, str]:
    return {name: text for name, text in read_tree(folder).items() if not name.startswith((".rcyaml/", ".vscode/"))}


def test_a_folder_becomes_a_workspace(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path / "old", TREE)
    result = rcyaml("migrate", "old", "-o", "new")
    assert result.exit_code == 0
    assert _documents(tmp_path / "new") == {
        "components/speech/speech.cdsl.yaml": "# yaml-language-server: $schema=../../.rcyaml/schemas/cdsl.schema.json\n"
        "component: SpeechComp\nlanguage: python\nimports: [Speech]\nimplements: [Speech]\n",
        "interfaces/Speech.idsl.yaml": "# yaml-language-server: $schema=../.rcyaml/schemas/idsl.schema.json\n"
        + SPEECH_YAML,
        "rcyaml.yaml": "# yaml-language-server: $schema=.rcyaml/schemas/workspace.schema.json\n"
        "interfaces: [interfaces]\n# Documents refer to files that were missing when they were migrated.\n"
        "lint:\n  RC1101: warning\n  RC2101: warning\n  RC2201: warning\n",
    }
    assert (tmp_path / "new/.rcyaml/schemas/idsl.schema.json").is_file()
    assert read_tree(tmp_path / "old") == TREE
    assert rcyaml("check", "new").exit_code == 0


def test_documents_are_in_the_folders_of_their_sources(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {**TREE, "rcyaml.yaml": "interfaces: [interfaces]\n"})
    assert rcyaml("migrate", "interfaces/Speech.idsl", "components").exit_code == 0
    texts = _documents(tmp_path)
    assert texts["rcyaml.yaml"] == "interfaces: [interfaces]\n"
    assert texts["interfaces/Speech.idsl.yaml"].startswith("# yaml-language-server: $schema=../.rcyaml/")
    assert texts["components/speech/speech.cdsl.yaml"].startswith("# yaml-language-server: $schema=../../.rcyaml/")
    assert not (tmp_path / "components/rcyaml.yaml").exists()
    assert rcyaml("check", ".").exit_code == 0


def test_a_second_run_changes_nothing(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, TREE)
    rcyaml("migrate", ".")
    before = {path: (path.stat().st_mtime_ns, path.stat().st_ino) for path in tmp_path.rglob("*") if path.is_file()}
    assert rcyaml("migrate", ".").exit_code == 0
    after = {path: (path.stat().st_mtime_ns, path.stat().st_ino) for path in tmp_path.rglob("*") if path.is_file()}
    assert after == before


def test_the_source_may_change_and_its_document_follows(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, TREE)
    rcyaml("migrate", ".")
    (tmp_path / "interfaces/Speech.idsl").write_text(SPEECH.replace("say(", "tell("), encoding="utf-8")
    assert rcyaml("migrate", ".").exit_code == 0
    assert "tell:" in (tmp_path / "interfaces/Speech.idsl.yaml").read_text(encoding="utf-8")


@pytest.mark.parametrize("renewed", [False, True])
def test_what_a_user_edited_is_kept(rcyaml: Run, tmp_path: Path, renewed: bool) -> None:
    write_tree(tmp_path, TREE)
    rcyaml("migrate", ".")
    document = tmp_path / "interfaces/Speech.idsl.yaml"
    document.write_text("# mine\n" + SPEECH_YAML, encoding="utf-8")
    if renewed:
        (tmp_path / "interfaces/Speech.idsl").write_text(SPEECH.replace("say(", "tell("), encoding="utf-8")
    result = rcyaml("migrate", ".", "--report", "-")
    assert result.exit_code == 0
    assert document.read_text(encoding="utf-8") == "# mine\n" + SPEECH_YAML
    assert ("RC5022" in result.output) is renewed

    forced = rcyaml("migrate", ".", "--force")
    assert forced.exit_code == 0
    assert "-# mine\n" in forced.stdout and "+++ interfaces/Speech.idsl.yaml\n" in forced.stdout
    assert document.read_text(encoding="utf-8").startswith("# yaml-language-server")


@pytest.mark.parametrize("options", [(), ("--force",)])
def test_a_file_of_the_user_is_never_overwritten(rcyaml: Run, tmp_path: Path, options: tuple[str, ...]) -> None:
    write_tree(tmp_path, {**TREE, "interfaces/Speech.idsl.yaml": "module: Mine\n"})
    result = rcyaml("migrate", ".", *options)
    assert result.exit_code == 1 and "RC5021" in result.stdout
    assert (tmp_path / "interfaces/Speech.idsl.yaml").read_text(encoding="utf-8") == "module: Mine\n"
    assert (tmp_path / "components/speech/speech.cdsl.yaml").is_file()


def test_dry_run_writes_nothing_and_diff_shows_all(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, TREE)
    result = rcyaml("migrate", ".", "--dry-run", "--diff")
    assert read_tree(tmp_path) == dict(sorted(TREE.items()))
    assert "--- /dev/null\n+++ interfaces/Speech.idsl.yaml\n" in result.stdout
    assert "+module: RoboCompSpeech\n" in result.stdout
    assert result.stdout.endswith("nothing was written (--dry-run)\n")


def test_one_bad_file_does_not_stop_the_others(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {**TREE, "interfaces/Bad.idsl": "module Bad {", "interfaces/Worse.idsl": b"\0\1"})
    result = rcyaml("migrate", ".")
    assert result.exit_code == 1
    assert (tmp_path / "interfaces/Speech.idsl.yaml").is_file()
    assert not (tmp_path / "interfaces/Bad.idsl.yaml").exists()
    lines = result.stdout.splitlines()[-4:]
    assert [line.split() for line in lines] == [
        ["converted", "warned", "refused", "skipped", "lines", "lost"],
        ["CDSL", "1", "0", "0", "0", "0"], ["IDSL", "1", "0", "2", "0", "0"], ["all", "2", "0", "2", "0", "0"],
    ]  # fmt: skip


def test_generated_configs_are_not_migrated_again(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, TREE)
    rcyaml("migrate", ".")
    assert rcyaml("compile").exit_code == 0
    before = read_tree(tmp_path)
    assert {"slice/Speech.ice", "runtime/python/generated/slice/CommonBehavior.ice"} <= set(before)
    result = rcyaml("migrate", ".")
    assert (result.exit_code, "Slice" in result.stdout) == (0, False)
    assert read_tree(tmp_path) == before


def test_a_config_that_compile_wrote_from_a_users_document_is_no_source(rcyaml: Run, tmp_path: Path) -> None:
    values = "component: ../speech.cdsl.yaml\nice: {Ice.Warn.Connections: 1}\n"
    write_tree(tmp_path, {"speech.cdsl.yaml": "component: Speech\nlanguage: python\n", "etc/config.yaml": values})
    assert rcyaml("compile").exit_code == 0
    assert (tmp_path / "etc/config").is_file()
    result = rcyaml("migrate", ".")
    assert (result.exit_code, result.stdout) == (0, "")
    assert "RC5021" in rcyaml("migrate", "etc/config").stdout, "the file itself, named, is one"


@pytest.mark.parametrize("path", ["Speech.idsl", "Speech.idsl.yaml", "notes.txt"])
def test_a_report_overwrites_nothing_but_a_report(path: str, rcyaml: Run, tmp_path: Path) -> None:
    files = {"Speech.idsl": SPEECH, "Speech.idsl.yaml": "module: Mine\n", "notes.txt": "mine\n"}
    write_tree(tmp_path, files)
    result = rcyaml("migrate", "Speech.idsl", "-o", "out", "--report", path)
    assert result.exit_code == 2
    assert f"--report does not overwrite {path}, which is not an earlier report" in result.output
    assert read_tree(tmp_path) == files
    for _ in range(2):
        assert rcyaml("migrate", "Speech.idsl", "-o", "out", "--report", "ledger.json").exit_code == 0


def test_a_report_is_the_only_standard_output(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"Speech.idsl": SPEECH + "#endif\n"})
    result = rcyaml("-v", "migrate", ".", "--dry-run", "--diff", "--report", "-")
    assert json.loads(result.stdout)["totals"]["files"] == 1
    assert "RC5005" in result.stderr and "nothing was written" in result.stderr


def test_the_report(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(
        tmp_path,
        {
            "in/Speech.idsl": SPEECH + "#endif\n",
            "in/Mouth.ice": '\n#pragma weird\n["cpp:const"]\nmodule Mouth { };\n',
            "in/Bad.idsl": "module Bad {\n\n// x\n",
        },
    )
    assert rcyaml("migrate", "in", "-o", "out", "--report", "ledger.json").exit_code == 1
    report = json.loads((tmp_path / "ledger.json").read_text(encoding="utf-8"))
    files = {entry["source"]: entry for entry in report["files"]}
    none = dict.fromkeys(("blank", "converted", "comment", "repaired", "lost", "refused"), 0)
    assert files["in/Speech.idsl"]["lines"] == {**none, "total": 6, "converted": 4, "comment": 1, "repaired": 1}
    assert files["in/Mouth.ice"]["lines"] == {
        **none, "total": 4, "blank": 1, "lost": 1, "comment": 1, "converted": 1,
    }  # fmt: skip
    assert files["in/Bad.idsl"]["lines"] == {**none, "total": 3, "blank": 1, "refused": 2}
    assert [files[name]["status"] for name in sorted(files)] == ["refused", "warned", "warned"]
    assert files["in/Speech.idsl"]["outputs"] == ["out/Speech.idsl.yaml"] and files["in/Bad.idsl"]["outputs"] == []
    assert [one["code"] for one in files["in/Mouth.ice"]["diagnostics"]] == ["RC5051", "RC5006"]
    assert report["totals"] == {
        "files": 3,
        "converted": 0,
        "warned": 2,
        "refused": 1,
        "skipped": 0,
        "lines": {"total": 13, "blank": 2, "converted": 5, "comment": 2, "repaired": 1, "lost": 1, "refused": 2},
    }


def test_strict_fails_on_a_loss(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"A.ice": "#pragma weird\nmodule A { };\n", "B.idsl": "module B { };\n#endif\n"})
    assert rcyaml("migrate", "A.ice").exit_code == 0
    assert rcyaml("migrate", "A.ice", "--strict").exit_code == 1
    assert rcyaml("migrate", "B.idsl", "--strict").exit_code == 0


def test_slice_generated_from_an_idsl_is_skipped(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"Speech.idsl": SPEECH, "Speech.ice": SPEECH, "Other.ICE": "module Other { };\n"})
    result = rcyaml("migrate", ".", "--report", "ledger.json")
    assert result.exit_code == 0
    files = json.loads((tmp_path / "ledger.json").read_text(encoding="utf-8"))["files"]
    assert {entry["source"]: entry["status"] for entry in files} == {
        "Other.ICE": "converted",
        "Speech.ice": "skipped",
        "Speech.idsl": "converted",
    }
    assert (tmp_path / "Other.idsl.yaml").is_file()


def test_imports_by_name_by_path_and_in_another_case(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(
        tmp_path,
        {
            "run/a.cdsl": 'import "x/speech.idsl"; import "../elsewhere/Far.idsl"; import "Gone.idsl";\n'
            "Component A { language cpp; };\n",
            "run/IDSLs/Speech.idsl": SPEECH,
            "elsewhere/Far.idsl": "module Far { };\n",
        },
    )
    result = rcyaml("migrate", "run", "--format", "json")
    assert [d["code"] for d in json.loads(result.stdout)["diagnostics"]] == ["RC5008", "RC5009"]
    text = (tmp_path / "run/a.cdsl.yaml").read_text(encoding="utf-8")
    assert "imports: [Speech, ../elsewhere/Far, Gone]\n" in text
    said = json.loads(rcyaml("check", "run", "--format", "json").stdout)["diagnostics"]
    assert {(d["code"], d["severity"]) for d in said} == {("RC2101", "warning")}


def test_parts_of_one_module_are_resolved(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(
        tmp_path,
        {
            "A.ice": "module M { struct S { int a; }; };\n",
            "B.ice": '#include "A.ice"\nmodule M { interface I { S f(M::S s); }; };\n',
        },
    )
    assert rcyaml("migrate", ".").exit_code == 0
    assert "f: {in: {s: A.S}, returns: A.S}" in (tmp_path / "B.idsl.yaml").read_text(encoding="utf-8")
    assert rcyaml("check", ".").exit_code == 0


def test_links_that_lead_in_circles(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {**TREE, "interfaces/again": "-> ../interfaces", "loop": "-> loop"})
    assert rcyaml("migrate", ".").exit_code == 0
    assert not (tmp_path / "interfaces/again/again").joinpath("x").exists()
    assert len(list(tmp_path.rglob("*.idsl.yaml"))) == 1


def test_nothing_is_written_through_a_link_that_leads_out(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"in/sub/Speech.idsl": SPEECH, "outside": None, "out/sub": "-> ../outside"})
    result = rcyaml("migrate", "in", "-o", "out")
    assert result.exit_code == 1 and "RC5023" in result.stdout
    assert list((tmp_path / "outside").iterdir()) == []


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_that_cannot_be_written(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"in/Speech.idsl": SPEECH, "out": None})
    (tmp_path / "out").chmod(0o500)
    result = rcyaml("migrate", "in", "-o", "out")
    assert result.exit_code == 1 and "RC5023" in result.stdout


def test_one_output_that_cannot_be_written_does_not_stop_the_others(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"in/a/Speech.idsl": SPEECH, "in/b/Mouth.idsl": "module Mouth { };\n", "out/a": "a file\n"})
    result = rcyaml("migrate", "in", "-o", "out")
    assert result.exit_code == 1 and result.stdout.count("RC5023") == 1
    assert (tmp_path / "out/b/Mouth.idsl.yaml").is_file()
    assert (tmp_path / "out/a").read_text(encoding="utf-8") == "a file\n"


def test_a_full_disk_leaves_everything_as_it_was(rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_tree(tmp_path, {"in/A.idsl": "module A { };\n", "in/B.idsl": "module B { };\n"})
    real = os.write

    def full(file: int, data: bytes) -> int:
        if b"module" in bytes(data):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return real(file, data)

    monkeypatch.setattr(os, "write", full)
    result = rcyaml("migrate", "in", "-o", "out")
    assert result.exit_code == 1
    assert result.stdout.count("RC5023") == 1 and "2 files below out cannot be written: no space left" in result.stdout
    assert not list(tmp_path.glob("out/**/*.idsl.yaml")) and not list(tmp_path.glob("out/**/*.new"))
    monkeypatch.undo()
    assert rcyaml("migrate", str(tmp_path / "in"), "-o", str(tmp_path / "out")).exit_code == 0


def test_names_with_blanks_and_letters_of_other_languages(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"mis señales/mi señal.idsl": "module Senal { };\n"})
    assert rcyaml("migrate", "mis señales").exit_code == 0
    assert (tmp_path / "mis señales/mi señal.idsl.yaml").is_file()


def test_diagnostics_as_data(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"X.idsl": "module X { struct S { int a } };\n"})
    data = json.loads(rcyaml("migrate", "X.idsl", "--format", "json").stdout)
    assert [(d["code"], d["line"], d["column"]) for d in data["diagnostics"]] == [("RC5003", 1, 27)]
    assert json.loads(rcyaml("migrate", "X.idsl", "--format", "sarif").stdout)["version"] == "2.1.0"


def test_quiet_and_verbose(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, TREE)
    assert rcyaml("-q", "migrate", ".").stdout == ""
    assert "unchanged interfaces/Speech.idsl.yaml\n" in rcyaml("-v", "migrate", ".").stdout


@pytest.mark.parametrize("files", [{"x": None}, {"x/README.md": "Hello\n", "x/main.cpp": "int main() {}\n"}])
def test_a_folder_without_legacy_files_is_told(rcyaml: Run, tmp_path: Path, files: dict[str, str | None]) -> None:
    """Nothing was lost, so this is no failure."""
    write_tree(tmp_path, files)
    before = read_tree(tmp_path)
    result = rcyaml("migrate", "x")
    assert result.exit_code == 0 and "warning[RC5024]" in result.stdout
    assert read_tree(tmp_path) == before


def test_a_missing_path_is_a_usage_error(rcyaml: Run) -> None:
    result = rcyaml("migrate", "no.idsl")
    assert result.exit_code == 2
    assert "'no.idsl' does not exist" in result.output
