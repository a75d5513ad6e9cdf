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
from robocomp_yaml.api.compile_stamps import CompileArguments
from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import table
from robocomp_yaml.diag.page import Files, Repeated
from robocomp_yaml.network.network import Network
from robocomp_yaml.transactions import stamp

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


ARM = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Arm.idsl.yaml": "module: RoboCompArm\ninterfaces: {Arm: {methods: {move: {}}}}\n",
    "interfaces/Eye.idsl.yaml": "module: RoboCompEye\ninterfaces: {Eye: {methods: {look: {}}}}\n",
    "arm/arm.cdsl.yaml": "component: ArmComp\nlanguage: python\nimports: [Arm]\nimplements: [Arm]\n",
    "arm/arm.pdsl.yaml": "component: arm.cdsl.yaml\nparameters: {speed: {type: float, default: 1}}\n",
    "arm/etc/config.yaml": "component: ../arm.cdsl.yaml\nparameters: {speed: 2}\n",
    "eye/eye.cdsl.yaml": "component: EyeComp\nlanguage: python\nimports: [Eye, Arm]\nrequires: [Arm]\nimplements: [Eye]\n",
    "robot.ddsl.yaml": "deployment: Robot\ncomponents: {arm: {component: arm}, eye: {component: eye}}\n",
}


def _linked(workspace: api.Workspace) -> dict[str, object]:
    program = workspace.analysis.program
    tables = program.modules, program.components, program.parameters, program.values
    return {os.path.relpath(real): linked for table in tables for real, linked in table.items()}


@pytest.mark.parametrize(
    ("edited", "others"),
    [
        ("interfaces/Eye.idsl.yaml", {"eye/eye.cdsl.yaml"}),
        (
            "interfaces/Arm.idsl.yaml",
            {"arm/arm.cdsl.yaml", "arm/arm.pdsl.yaml", "arm/etc/config.yaml", "eye/eye.cdsl.yaml"},
        ),
        ("arm/arm.pdsl.yaml", {"arm/arm.cdsl.yaml", "arm/etc/config.yaml"}),
        ("arm/arm.cdsl.yaml", {"arm/arm.pdsl.yaml", "arm/etc/config.yaml"}),
        ("arm/etc/config.yaml", set()),
        ("robot.ddsl.yaml", set()),
    ],
)
@pytest.mark.parametrize("is_saved", [True, False])
def test_what_does_not_refer_to_an_edited_document_is_the_same_linked_object(
    edited: str, others: set[str], is_saved: bool
) -> None:
    write_tree(Path(), ARM)
    living = api.follow()
    before = _linked(living.load())
    if is_saved:
        write_tree(Path(), {edited: f"# more\n{ARM[edited]}"})
    else:
        living.edit(edited, f"# more\n{ARM[edited]}")
    after = _linked(living.load())
    assert after.keys() == before.keys()
    changed = {path for path in after if after[path] is not before[path]}
    assert changed == ({edited, *others} & after.keys())


def test_a_recalled_compile_has_the_stamp_of_a_fresh_one() -> None:
    write_tree(Path(), ARM)
    living = api.follow()
    living.load().compile().apply()
    living.load().compile().apply()
    write_tree(Path(), {"robot.ddsl.yaml": f"# more\n{ARM['robot.ddsl.yaml']}"})
    living.load().compile().apply()
    folder, name = CompileArguments((".",), ()).location()
    recalled = stamp.load(folder, name)
    assert recalled is not None and stamp.is_current(recalled)
    api.load().compile().apply()
    assert stamp.load(folder, name) == recalled


def test_a_manifest_that_somebody_deletes_is_noticed() -> None:
    """Then the user's flat config is his own, and its values document has no effect."""
    write_tree(Path(), ARM)
    living = api.follow()
    living.load().compile().apply()
    Path("arm/etc/config").write_text(Path("arm/etc/config").read_text().replace("speed=2", "speed=3"))
    _is_as_fresh(living)
    Path("arm/.rcyaml/manifest.json").unlink()
    _is_as_fresh(living)


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
