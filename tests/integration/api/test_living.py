"""The living analysis: every diagnostic moves with its line and goes with its cause; files that appear and vanish."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest
from msgspec.structs import replace

from conftest import Tree, write_tree
from robocomp_yaml import api
from robocomp_yaml.addresses.port_numbers import USUAL, default_port
from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import table
from robocomp_yaml.diag.page import Files, Repeated
from robocomp_yaml.network.network import Network

ROWS = [row for row in table().values() if row.command.startswith("check")]
LONGEST = 100_000


def shown(networks: Mapping[str, Network]) -> str:
    """The networks as text, without the functions that look up the origin of values."""
    return repr({path: replace(network, settings={}) for path, network in networks.items()})


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])


def _texts(files: Files) -> Tree:
    return {path: str(it) if isinstance(it, Repeated) else it for path, it in files.items()}


def _shifted(files: Tree) -> dict[str, str]:
    """The documents with another line above all others, as an editor has them."""
    return {
        path: f"# more\n{text}"
        for path, text in files.items()
        if isinstance(text, str) and path.endswith(".yaml") and not text.startswith(("-> ", "%", "\ufeff"))
    }


def _is_as_fresh(living: api.LivingWorkspace) -> list[api.Diagnostic]:
    found, fresh = living.load(), api.load(overlay=living.unsaved)
    assert found.check() == fresh.check()
    assert shown(found.networks) == shown(fresh.networks)
    return found.check()


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.id)
def test_a_diagnostic_moves_with_its_line_and_goes_with_its_cause(row: Code) -> None:
    wrong, right = _texts(row.wrong), _texts(row.right)
    if sum(len(text) for text in wrong.values() if text is not None) > LONGEST:
        pytest.skip("it takes long")
    write_tree(Path(), wrong)
    if any(path.startswith("site-packages/") for path in wrong):
        sys.path.insert(0, os.path.abspath("site-packages"))
    living = api.follow()
    before = [one for one in _is_as_fresh(living) if one.code == row.id]
    for path, text in _shifted(wrong).items():
        living.edit(path, text)
        _is_as_fresh(living)
    after = [one for one in _is_as_fresh(living) if one.code == row.id]
    assert len(before) == len(after)
    for path in living.unsaved:
        living.edit(path, None)
    assert [one for one in _is_as_fresh(living) if one.code == row.id] == before
    for path in wrong.keys() - right.keys():
        if Path(path).is_file() and not path.startswith("site-packages/"):
            Path(path).unlink()
    for path, content in right.items():
        if isinstance(content, str) and path.endswith(".yaml"):
            living.edit(path, content)
        elif not Path(path).is_symlink():
            write_tree(Path(), {path: content})
    _is_as_fresh(living)


USED = {
    "arm.cdsl.yaml": "component: ArmComp\nlanguage: python\n",
    "spare.config.yaml": "parameters: {speed: 1}\n",
    "a.ddsl.yaml": "deployment: A\ncomponents: {arm: {component: arm.cdsl.yaml, config: spare.config.yaml}}\n",
}


@pytest.mark.parametrize("gone", ["a.ddsl.yaml", "b.ddsl.yaml"])
@pytest.mark.parametrize("how", ["removed", "broken", "without the entry"])
def test_values_belong_to_a_component_as_long_as_any_deployment_uses_them_for_it(gone: str, how: str) -> None:
    write_tree(Path(), USED)
    living = api.follow()
    _is_as_fresh(living)
    write_tree(Path(), {"b.ddsl.yaml": USED["a.ddsl.yaml"].replace("A", "B")})
    _is_as_fresh(living)
    if how == "removed":
        Path(gone).unlink()
    else:
        living.edit(gone, "deployment: [" if how == "broken" else "deployment: C\ncomponents: {}\n")
    found = [one.code for one in _is_as_fresh(living)]
    assert "RC3301" in found  # unknown parameter
    assert "RC3323" not in found  # these values belong to no component


def test_the_settings_of_a_deployment_that_names_no_document_are_reported_again() -> None:
    tree = {"rcyaml.yaml": "interfaces: [gone]\n", "a.ddsl.yaml": "deployment: A\ncomponents: {a: {program: sleep}}\n"}
    write_tree(Path(), tree)
    living = api.follow()
    for _ in range(3):
        assert [one.code for one in living.look("a.ddsl.yaml").check()] == ["RC0301"]
        assert [one.code for one in living.load().check()] == ["RC0301"]


def test_a_network_depends_on_the_components_that_appear_elsewhere_in_its_workspace() -> None:
    """A proxy that rcyaml would write if nobody sets one counts as none, and others' components decide which it is."""
    arm = "language: python\nimports: [../interfaces/Arm]\n"
    proxy = f"Proxies.Arm=arm:tcp -h localhost -p {default_port('HandComp', 'Arm', USUAL)}\n"
    tree = {
        "rcyaml.yaml": "",
        "interfaces/Arm.idsl.yaml": "module: RoboCompArm\ninterfaces: {Arm: {methods: {move: {}}}}\n",
        "arm/arm.cdsl.yaml": f"component: ArmComp\nrequires: [Arm]\n{arm}",
        "arm/etc/config": proxy,
        "lab/lab.ddsl.yaml": "deployment: Lab\ncomponents: {arm: {component: ../arm}}\n",
    }
    write_tree(Path(), tree)
    living = api.follow()

    def proxies() -> list[str]:
        living.refresh()
        found, fresh = living.look("lab/lab.ddsl.yaml"), api.load("lab/lab.ddsl.yaml")
        assert found.check() == fresh.check()
        assert shown(found.networks) == shown(fresh.networks)
        return [one.proxy for one in found.network().connections]

    assert proxies() == proxies() == [proxy.strip().partition("=")[2]]
    write_tree(Path(), {"hand/hand.cdsl.yaml": f"component: HandComp\nimplements: [Arm]\n{arm}"})
    assert proxies() == proxies() == [""]
