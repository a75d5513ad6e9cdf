"""Where a required interface is served in a workspace: by content, at the other's own port, as in its values."""

from __future__ import annotations

from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml.addresses.own import OwnText
from robocomp_yaml.addresses.port_numbers import default_port
from robocomp_yaml.addresses.table import PortTable
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.pipeline import analyse
from talk import INTERFACES, component, workspace


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def table(requested: str = ".") -> tuple[PortTable, dict[str, LinkedComponent]]:
    analysis = analyse([requested])
    linked = {Path(one.component.path).parent.name: one for one in analysis.program.components.values()}
    return analysis.addresses.table(linked["a"]), linked


def proxy(requested: str = ".") -> str:
    found, linked = table(requested)
    return found.resolve(linked["a"])["Mouth"].proxy


PAIR = {"a": component("A", requires="[Mouth]"), "b": component("B", implements="[Mouth]")}


@pytest.mark.parametrize("requested", [".", "a", "a/a.cdsl.yaml"])
def test_the_other_is_resolved_whatever_is_requested(requested: str) -> None:
    workspace(PAIR, b="Mouth.Endpoints=tcp -p 12345\n")
    assert proxy(requested) == "mouth:tcp -h localhost -p 12345"


def test_the_values_of_the_other_count() -> None:
    workspace(PAIR)
    write_tree(
        Path(), {"b/etc/config.yaml": "component: ../b.cdsl.yaml\nendpoints: {Mouth: ws -h 10.0.0.7 -p 12345}\n"}
    )
    assert proxy() == proxy("a") == "mouth:ws -h 10.0.0.7 -p 12345"


def test_a_copy_of_an_interface_is_the_same_interface() -> None:
    workspace(PAIR, b="Mouth.Endpoints=tcp -p 12345\n")
    write_tree(Path(), {"b/Talk.idsl.yaml": "# a copy\n" + INTERFACES})
    assert proxy() == "mouth:tcp -h localhost -p 12345"


def test_another_interface_of_the_same_name_is_another_one() -> None:
    workspace(PAIR, b="Mouth.Endpoints=tcp -p 12345\n")
    write_tree(Path(), {"b/Talk.idsl.yaml": INTERFACES.replace("{open: }", "{shut: }")})
    assert proxy() == f"mouth:tcp -h localhost -p {default_port('', 'Mouth')}"


def test_a_component_does_not_serve_itself() -> None:
    workspace({"a": component("A", requires="[Mouth]", implements="[Mouth]")})
    found, linked = table()
    assert found.resolve(linked["a"])["Mouth"].component is None


@pytest.mark.parametrize(
    ("text", "is_default"),
    [
        (f"tcp -p {default_port('B', 'Mouth')}", True),
        (f"tcp -p {default_port('B', 'Mouth') + 1}", False),
        (f"ws -p {default_port('B', 'Mouth')}", False),
        (f"tcp -h 10.0.0.1 -p {default_port('B', 'Mouth')}", False),
        ("nonsense", False),
    ],
)
def test_a_default_endpoint(text: str, is_default: bool) -> None:
    workspace(PAIR)
    found, linked = table()
    assert found.is_default_endpoint(linked["b"], "Mouth", OwnText(text, Span(""))) is is_default


def test_the_next_port_is_a_default_if_the_first_is_taken() -> None:
    first = default_port("B", "Mouth")
    workspace(PAIR | {"c": component("C", implements="[Speech]")}, c=f"Speech.Endpoints=tcp -p {first}\n")
    found, linked = table()
    assert found.is_default_endpoint(linked["b"], "Mouth", OwnText(f"tcp -p {first + 1}", Span("")))
    assert not found.is_default_endpoint(linked["b"], "Mouth", OwnText(f"tcp -p {first + 2}", Span("")))


def test_what_rcyaml_wrote_stays_a_default_when_the_range_changes() -> None:
    workspace(PAIR)
    Path("rcyaml.yaml").write_text("interfaces: [idsl/]\nports: {from: 13000, to: 13999}\n", encoding="utf-8")
    found, linked = table()
    assert found.is_default_endpoint(linked["b"], "Mouth", OwnText(f"tcp -p {default_port('B', 'Mouth')}", Span("")))
