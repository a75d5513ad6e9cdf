"""Who can be called from outside of a network, and where: nothing runs here."""

from __future__ import annotations

from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml import api
from robocomp_yaml.api.addresses import Addresses
from robocomp_yaml.diag.errors import Faulty, Refused

EYES = """\
module: RoboCompEyes
interfaces:
  Camera:
    methods:
      shoot: {returns: int}
      close:
  Lens:
    methods:
      focus: {in: {far: float}}
      close:
"""
CDSL = "component: Eye\nlanguage: python\nimports: [../Eyes]\nimplements: [Lens, {Left: Camera}]\n"
DEPLOYMENT = """\
deployment: Head
hosts: {body: 10.0.0.5, six: "fd00::6"}
components:
  eye: {component: eye, host: body, ports: {Lens: 12001, Left: 12002}}
  far: {component: eye, host: six, endpoints: {Lens: ssl -p 12003}}
  twin: {process: eye}
  old: {program: ./camera, host: body, endpoints: {Camera: tcp -p 12009, RoboCompEyes.Lens: tcp -p 12010}}
  web: {program: ./web, host: body}
"""
ARM = "deployment: Arm\nhosts: {body: 10.0.0.5}\ncomponents:\n  hand: {component: eye, host: body, ports: {Lens: 12011}}\n"


@pytest.fixture(autouse=True)
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_tree(tmp_path, {"rcyaml.yaml": "{}\n", "Eyes.idsl.yaml": EYES, "eye/eye.cdsl.yaml": CDSL})
    monkeypatch.chdir(tmp_path)


def proxy(addresses: Addresses, text: str) -> str:
    _, door, _ = addresses.method(text)
    return door.proxy


def test_entries_on_their_hosts() -> None:
    write_tree(Path(), {"head.ddsl.yaml": DEPLOYMENT})
    addresses = Addresses()
    assert proxy(addresses, "eye.Lens.focus") == "lens:tcp -h 10.0.0.5 -p 12001"
    assert proxy(addresses, "eye.Left.shoot") == "camera:tcp -h 10.0.0.5 -p 12002"  # the adapter's name, or
    assert proxy(addresses, "eye.Camera.shoot") == "camera:tcp -h 10.0.0.5 -p 12002"  # that of the interface
    assert proxy(addresses, "far.Lens.focus") == 'lens:ssl -h "fd00::6" -p 12003'
    assert proxy(addresses, "twin.focus") == "lens:tcp -h 10.0.0.5 -p 12001"
    assert proxy(addresses, "old.Camera.shoot") == "camera:tcp -h 10.0.0.5 -p 12009"
    assert proxy(addresses, "old.Lens.focus") == "lens:tcp -h 10.0.0.5 -p 12010"
    assert proxy(addresses, "eye.CommonBehavior.getState").startswith("commonbehavior:tcp -h 10.0.0.5 -p ")
    with pytest.raises(
        Refused, match="several interfaces have a method 'close'; write eye.Lens.close or eye.Left.close"
    ):
        addresses.method("eye.close")


def test_where_a_component_without_deployment_is() -> None:
    write_tree(Path(), {"eye/etc/config": "Lens.Endpoints=ssl -h 127.0.0.1 -p 12021\n"})
    addresses = Addresses()
    assert proxy(addresses, "Eye.Lens.focus") == "lens:ssl -h 127.0.0.1 -p 12021"
    assert proxy(addresses, "eye.Left.shoot").startswith("camera:tcp -h localhost -p ")


def test_host_and_port() -> None:
    addresses = Addresses()
    assert proxy(addresses, "robot.local:12001.Lens.focus") == "lens:tcp -h robot.local -p 12001"
    assert proxy(addresses, "10.0.0.5:12001.RoboCompEyes.Lens.focus") == "lens:tcp -h 10.0.0.5 -p 12001"
    assert proxy(addresses, "[fd00::6]:12001.Lens.focus") == 'lens:tcp -h "fd00::6" -p 12001'
    assert proxy(addresses, "ssl:robot:12001.Lens.focus") == "lens:ssl -h robot -p 12001"


def test_includes_by_their_full_names() -> None:
    include = (
        DEPLOYMENT.partition("components:")[0]
        + "include: {arm: arm.ddsl.yaml}\ncomponents:\n  eye: {component: eye, host: body}\n"
    )
    write_tree(Path(), {"head.ddsl.yaml": include, "arm.ddsl.yaml": ARM})
    addresses = Addresses()
    assert proxy(addresses, "arm.hand.Lens.focus").endswith(" -p 12011")
    assert "arm.hand" in addresses.names()


def test_the_same_module_twice() -> None:
    """Two documents of one module: each component has its own; a port may have either."""
    write_tree(Path(), {"b/Eyes.idsl.yaml": EYES.replace("far: float", "far: double")})
    addresses = Addresses()
    assert addresses.method("Eye.Lens.focus")[2].inputs[0].type.text == "float"


def test_errors_of_documents_are_told() -> None:
    write_tree(Path(), {"Eyes.idsl.yaml": EYES.replace("float", "flaot")})
    with pytest.raises(Faulty) as found:
        Addresses().method("localhost:12001.Lens.focus")
    assert [one.code for one in found.value.diagnostics] == ["RC1010"]
    write_tree(
        Path(),
        {"Eyes.idsl.yaml": EYES, "head.ddsl.yaml": "deployment: Head\ncomponents: {eye: {component: nowhere}}\n"},
    )
    with pytest.raises(Faulty):
        Addresses("head.ddsl.yaml").method("eye.Lens.focus")


def test_a_name_that_a_broken_deployment_may_have_is_no_component() -> None:
    """`eye` is the folder of a component, too, but its own address may be that of another process."""
    write_tree(Path(), {"head.ddsl.yaml": DEPLOYMENT + "components: [\n"})
    with pytest.raises(Faulty) as found:
        Addresses().peer("eye.Lens.focus")
    assert [one.code for one in found.value.diagnostics] == ["RC0101"]
    for own in ("Eye.Lens.focus", "./eye.Lens.focus"):
        assert Addresses().peer(own).name == "Eye"
    with pytest.raises(Faulty):
        Addresses().refuse_unread()


def test_a_closed_group_is_one_component() -> None:
    """What it offers has its own names; rules are enforced by a gate."""
    groups = "groups:\n  face: {components: [eye], expose: {Sharp: eye.Lens, Left: {member: eye, rate: 10}}}\n"
    write_tree(
        Path(),
        {
            "head.ddsl.yaml": f"deployment: Head\ncomponents: {{eye: {{component: eye, ports: {{Lens: 12001, Left: 12002}}}}}}\n{groups}"
        },
    )
    addresses = Addresses()
    assert [str(one) for one in addresses.analysis.diagnostics if one.severity == "error"] == []
    assert proxy(addresses, "face.Sharp.focus") == "lens:tcp -h 127.0.0.1 -p 12001"
    gate = next(one for one in addresses.network.processes.values() if one.name == "face.gate")  # type: ignore[union-attr]
    assert proxy(addresses, "face.Left.shoot") == f"camera:tcp -h 127.0.0.1 -p {gate.endpoints[0].port}"
    with pytest.raises(Refused, match="face has no method 'zoom'"):
        addresses.method("face.zoom")


def test_the_nearest_deployment(monkeypatch: pytest.MonkeyPatch) -> None:
    """That below the working folder, else that of the workspace."""
    for folder, port in (("a", 12031), ("b", 12032)):
        text = f"deployment: D{folder}\ncomponents: {{eye: {{component: ../eye, ports: {{Lens: {port}}}}}}}\n"
        write_tree(Path(), {f"{folder}/head.ddsl.yaml": text, f"{folder}/sub/x": ""})
    with pytest.raises(Refused, match="name one with --deployment a/head.ddsl.yaml"):
        Addresses().method("eye.Lens.focus")
    monkeypatch.chdir("b")
    assert proxy(Addresses(), "eye.Lens.focus").endswith(" -p 12032")
    assert proxy(Addresses("../a"), "eye.Lens.focus").endswith(" -p 12031")


def test_a_port_of_the_user_stays_the_users() -> None:
    """Each compile keeps what it would write today, to compare the user's files with it later: never the user's own
    port, which a deployment would then take for a default."""
    write_tree(Path(), {"head.ddsl.yaml": "deployment: Head\ncomponents: {lips: {component: eye}}\n"})
    api.load(".").compile().apply()
    config = Path("eye/etc/config")
    default = proxy(Addresses(), "lips.Lens.focus")
    for port in (12345, 12346):
        lines = config.read_text(encoding="utf-8").splitlines()
        changed = [f"Lens.Endpoints=tcp -p {port}" if line.startswith("Lens.Endpoints") else line for line in lines]
        config.write_text("\n".join(changed) + "\n", encoding="utf-8")
        for _ in range(2):
            assert proxy(Addresses(), "lips.Lens.focus") == f"lens:tcp -h 127.0.0.1 -p {port}" != default
            api.load(".").compile().apply()
    assert config.read_text(encoding="utf-8").count("12346") == 1


def test_a_deployment_from_elsewhere_comes_with_its_own_workspace(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """A working folder that is in no workspace is not read: there can be a whole disk below it."""
    write_tree(tmp_path, {"head.ddsl.yaml": DEPLOYMENT, "ear/ear.cdsl.yaml": CDSL.replace("Eye\n", "Ear\n", 1)})
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    write_tree(elsewhere, {"x.cdsl.yaml": "component: Stranger\nlanguage: python\n"})
    monkeypatch.chdir(elsewhere)
    assert "Stranger" in Addresses().names()
    names = Addresses(str(tmp_path / "head.ddsl.yaml")).names()
    assert {"eye", "Ear"} <= {*names} and "Stranger" not in names
