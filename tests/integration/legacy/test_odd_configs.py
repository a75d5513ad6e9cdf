"""Flat configs with odd names, odd keys, and thousands of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from click.testing import Result

from conftest import write_tree

Run = Callable[..., Result]


def test_odd_names_and_odd_keys(rcyaml: Run, tmp_path: Path) -> None:
    many = "".join(f"K{number}.a.b{number} = {number}\n" for number in range(3000))
    write_tree(tmp_path, {
        "config con ñ": "a" + ".b" * 3000 + " = 1\nClass.class = 2\nx-y = 3\n", "config_many": many,
        "config_crlf": "# a\r\nA = 1\r\n", "config_bom": b"\xef\xbb\xbfA = 1\n", "config_latin": b"A = \xf1\n",
    })  # fmt: skip
    result = rcyaml("migrate", ".", "--report", "ledger.json")
    assert result.exit_code == 0, result.output
    assert "parameters:\n  A: ñ\n" in (tmp_path / "config_latin.config.yaml").read_text(encoding="utf-8")
    checked = rcyaml("check", ".")
    assert "error" not in checked.output.replace("0 errors", ""), checked.output


def test_backups_of_editors_are_not_configs(rcyaml: Run, tmp_path: Path) -> None:
    component = "Component arm { Communications { }; language python; };\n"
    others = ("config~", "config.bak", "config_real.old", "arm.conf~", "config.orig", ".config.swp")
    write_tree(tmp_path, {
        "arm/arm.cdsl": component, "arm/etc/config": "Speed = 3\n", "arm/etc/config_real": "Speed = 4\n",
        **{f"arm/etc/{name}": "Speed = fast\nOld = 1\n" for name in others},
    })  # fmt: skip
    assert rcyaml("migrate", ".").exit_code == 0
    assert sorted(path.name for path in (tmp_path / "arm/etc").glob("*.yaml")) == [
        "config.yaml",
        "config_real.config.yaml",
    ]
    assert "Speed: int" in (tmp_path / "arm/arm.pdsl.yaml").read_text()


def test_a_latin_config_of_a_component(rcyaml: Run, tmp_path: Path) -> None:
    """Programs read UTF-8 only: the warning says so, and its hint works."""
    component = "Component arm { Communications { }; language python; };\n"
    write_tree(tmp_path, {"arm.cdsl": component, "etc/config": "Título = año\n".encode("latin-1")})
    assert rcyaml("migrate", ".").exit_code == 0
    checked = rcyaml("check")
    assert checked.exit_code == 0 and "not UTF-8" in checked.output, checked.output
    assert "RC6010" in rcyaml("compile").output
    assert rcyaml("compile", "--adopt", "arm.cdsl.yaml").exit_code == 0
    assert "Título=año" in (tmp_path / "etc/config").read_text(encoding="utf-8")
    assert "nothing wrong" in rcyaml("check").output


def test_binary_files_are_of_other_programs(rcyaml: Run, tmp_path: Path) -> None:
    """A file with the name of a config, but not an interface, which somebody needs."""
    write_tree(tmp_path, {"arm.cdsl": "Component arm { Communications { }; language python; };\n",
                          "etc/config_map": b"\x00\x01map=1\n", "etc/config": "A = 1\n"})  # fmt: skip
    result = rcyaml("migrate", ".")
    assert result.exit_code == 0 and "note[RC5043]" in result.output and "config_map" in result.output, result.output
    (tmp_path / "Arm.idsl").write_bytes(b"\x00\x01")
    assert rcyaml("migrate", ".").exit_code == 1
