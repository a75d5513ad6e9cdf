"""A values document that is written after the first compile keeps the settings and ports of the component."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

Run = Callable[..., Result]
IDSL = "module: RoboComp{0}\ninterfaces: {{{0}: {{methods: {{go: }}}}}}\n"
TREE = {
    "Mouth.idsl.yaml": IDSL.format("Mouth"),
    "mouth/m.cdsl.yaml": "component: MouthComp\nlanguage: python\nimports: [../Mouth]\nimplements: [Mouth]\n",
    "mouth/etc/config": "Mouth.Endpoints=tcp -p 12321\n",
    "speech/s.cdsl.yaml": "component: SpeechComp\nlanguage: python\nimports: [../Mouth]\nrequires: [Mouth]\n",
    "speech/s.pdsl.yaml": "component: s.cdsl.yaml\nparameters: {volume: {type: int, default: 5}, Net: {group: "
                          "{host: {type: string, default: here}}}}\n",
}  # fmt: skip
VALUES = "component: ../s.cdsl.yaml\n"
WORKSPACE = {"rcyaml.yaml": ""}


def _proxy(folder: Path) -> str:
    [line] = [x for x in (folder / "speech/etc/config").read_text().splitlines() if x.startswith("MouthProxy=")]
    return line.rpartition(" ")[2]


@pytest.mark.parametrize("what", [".", "speech", "speech/s.cdsl.yaml"])
def test_an_open_proxy_gets_the_served_port(rcyaml: Run, tmp_path: Path, what: str) -> None:
    write_tree(tmp_path, {**TREE, **WORKSPACE, "speech/etc/config.yaml": VALUES})
    for _ in range(3):
        assert rcyaml("compile", what).exit_code == 0
        assert _proxy(tmp_path) == "12321"


def test_without_a_workspace_the_port_is_kept(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {**TREE, "speech/etc/config.yaml": VALUES})
    assert rcyaml("compile").exit_code == 0
    (tmp_path / "speech/s.pdsl.yaml").write_text(TREE["speech/s.pdsl.yaml"].replace("5", "6"))
    assert rcyaml("compile", "speech/s.cdsl.yaml").exit_code == 0  # which knows of no neighbour
    assert "volume=6\n" in (tmp_path / "speech/etc/config").read_text()
    assert _proxy(tmp_path) == "12321"


def test_the_proxy_follows_the_neighbour(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {**TREE, **WORKSPACE, "speech/etc/config.yaml": VALUES})
    assert rcyaml("compile", "speech").exit_code == 0
    assert "0 files written" in rcyaml("compile", "speech").stdout
    write_tree(tmp_path, {"mouth/etc/config": "Mouth.Endpoints=tcp -p 12555\n"})
    assert rcyaml("compile", "speech").exit_code == 0
    assert _proxy(tmp_path) == "12555"
    # The user's etc/config counts, until a compile replaces it.
    write_tree(tmp_path, {"mouth/etc/config.yaml": "component: ../m.cdsl.yaml\nendpoints: {Mouth: tcp -p 12777}\n"})
    assert rcyaml("compile", "speech").exit_code == 0
    assert _proxy(tmp_path) == "12555"
    assert rcyaml("compile", "--adopt", "mouth").exit_code == 0
    assert rcyaml("compile", "speech").exit_code == 0
    assert _proxy(tmp_path) == "12777"


def test_a_merged_proxy_has_the_served_port(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(
        tmp_path,
        {**TREE, **WORKSPACE, "speech/s.cdsl.yaml": TREE["speech/s.cdsl.yaml"].replace("requires: [Mouth]\n", "")},
    )
    assert rcyaml("compile").exit_code == 0
    write_tree(tmp_path, {"speech/s.cdsl.yaml": TREE["speech/s.cdsl.yaml"]})
    assert "-p 12321" in rcyaml("compile").stdout  # RC6206, with the lines to paste
    assert rcyaml("compile", "--merge").exit_code == 0
    assert _proxy(tmp_path) == "12321"


@pytest.mark.parametrize("is_compiled", [True, False])
def test_a_first_document_has_the_port_of_the_neighbour(rcyaml: Run, tmp_path: Path, is_compiled: bool) -> None:
    write_tree(tmp_path, {**TREE, **WORKSPACE})
    if is_compiled:
        assert rcyaml("compile").exit_code == 0
    assert rcyaml("config", "new", "SpeechComp").exit_code == 0
    assert 'Mouth: "mouth:tcp -h localhost -p 12321"\n' in (tmp_path / "speech/etc/config.yaml").read_text()
    assert rcyaml("compile").exit_code == 0
    assert _proxy(tmp_path) == "12321"
    assert not list(tmp_path.rglob("*.orig"))


def test_a_first_document_copies_the_edits_of_the_user(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {**TREE, **WORKSPACE})
    assert rcyaml("compile").exit_code == 0
    config = tmp_path / "speech/etc/config"
    mine = config.read_text().replace("12321", "10100") + (
        "volume=8\nNet.host=there\nIce.Trace.Slicing=1\nMine.Own=7 \\# of\nCommonBehavior.ThreadPool.Size=3\n"
    )
    config.write_text(mine)
    assert rcyaml("config", "new", "speech").exit_code == 0
    text = (tmp_path / "speech/etc/config.yaml").read_text()
    for line in ("  volume: 8\n", "    host: there\n", 'Trace.Slicing: "1"\n', '  Mine.Own: "7 # of"\n'):
        assert line in text
    assert "speed" not in text
    result = rcyaml("compile")
    assert result.exit_code == 0, result.output  # nothing of the user's would be lost
    assert (tmp_path / "speech/etc/config.orig").read_text() == mine
    now = config.read_text()
    assert _proxy(tmp_path) == "10100"
    assert all(
        f"{line}\n" in now for line in ("volume=8", "Net.host=there", "Ice.Trace.Slicing=1", "Mine.Own=7 \\# of")
    )
    assert "CommonBehavior.ThreadPool.Size=3\n" in now


def test_an_edit_that_would_be_lost_is_reported(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {**TREE, **WORKSPACE})
    assert rcyaml("compile").exit_code == 0
    config = tmp_path / "speech/etc/config"
    config.write_text(config.read_text().replace("period.compute=100", "period.compute=20"))
    write_tree(tmp_path, {"speech/etc/config.yaml": VALUES})
    result = rcyaml("compile")
    assert result.exit_code == 0
    assert "RC6010" in result.stdout
    assert "set them in speech/etc/config.yaml as well" in result.stdout
    assert "period.compute=20\n" in config.read_text()
    assert rcyaml("config", "set", "speech", "period.compute", "20").exit_code == 0
    assert rcyaml("compile").exit_code == 0
    assert "period.compute=20\n" in config.read_text()
    assert "period.compute=20\n" in (tmp_path / "speech/etc/config.orig").read_text()


def test_the_newer_dialect_is_read(rcyaml: Run, tmp_path: Path) -> None:
    config = 'Proxies.Mouth = "mouth:tcp -h there -p 10200"\nEndpoints.CommonBehavior = "tcp -p 10300"\nvolume = 9\n'
    write_tree(tmp_path, {**TREE, **WORKSPACE, "speech/etc/config": f'{config}Net.host = "robot"\nMine = "x"\n'})
    assert rcyaml("config", "new", "speech").exit_code == 0
    text = (tmp_path / "speech/etc/config.yaml").read_text()
    for line in (
        'Mouth: "mouth:tcp -h there -p 10200"',
        "CommonBehavior: tcp -p 10300",
        "volume: 9",
        "host: robot",
        "Mine: x",
    ):
        assert f"  {line}\n" in text, text
    assert rcyaml("config", "check", "speech").exit_code == 0


def test_what_an_earlier_version_wrote_is_not_the_users(rcyaml: Run, tmp_path: Path) -> None:
    """It set defaults of Ice, which are part of the run time today."""
    write_tree(tmp_path, {**TREE, **WORKSPACE})
    assert rcyaml("compile").exit_code == 0
    flat = tmp_path / "speech/etc/config"
    earlier = flat.read_text(encoding="utf-8").replace("# Ice.", "Ice.")
    assert "\nIce.MessageSizeMax=20004800\n" in earlier
    flat.write_text(earlier.replace("Ice.Trace.Network=0", "Ice.Trace.Network=1"), encoding="utf-8")
    shutil.rmtree(tmp_path / "speech/.rcyaml")
    assert "RC33" not in rcyaml("check").stdout
    assert rcyaml("config", "new", "speech").exit_code == 0
    values = (tmp_path / "speech/etc/config.yaml").read_text(encoding="utf-8")
    assert 'Trace.Network: "1"' in values and "MessageSizeMax" not in values and "Warn.Connections" not in values
