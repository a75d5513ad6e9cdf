"""`alive:` of documents and entries: who is asked, how often, and what then."""

from __future__ import annotations

from pathlib import Path

import pytest

from deployments import deployed, faults, network
from robocomp_yaml.network.network import AUTO, FOREVER

LAMP = {
    "Lamp.idsl.yaml": "module: RoboCompLamp\ninterfaces: {Lamp: {methods: {light: {}}}}\n",
    "lamp/lamp.cdsl.yaml": "component: LampComp\nlanguage: python\nimports: [../Lamp]\nimplements: [Lamp]\n",
}


@pytest.fixture(autouse=True)
def _in_its_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


DEFAULT = (5.0, 2.0, 2, True, AUTO)


@pytest.mark.parametrize(
    ("document", "entry", "expected"),
    [
        ("", "", DEFAULT),
        ("", "alive: on", DEFAULT),
        ("", "alive: off", None),
        ("alive: off", "", None),
        ("alive: off", "alive: on", DEFAULT),
        ("alive: off", "alive: {every: 1 s}", (1.0, 2.0, 2, True, AUTO)),
        ("alive: {every: 1 s, then: tell}", "alive: {misses: 3}", (1.0, 2.0, 3, False, AUTO)),
        ("alive: {then: tell}", "alive: {then: restart}", DEFAULT),
        ("alive: {every: 1 s}", "alive: off", None),
        ("", "alive: {within: 500, worker: 1 min}", (5.0, 0.5, 2, True, 60.0)),
        ("alive: {worker: 1 min}", "alive: {worker: off}", (5.0, 2.0, 2, True, FOREVER)),
        ("", "alive: {x-note: 3}", DEFAULT),
    ],
)
def test_a_component(document: str, entry: str, expected: tuple[object, ...] | None) -> None:
    text = f"{document}\ncomponents: {{lamp: {{component: lamp{', ' + entry if entry else ''}}}}}\n"
    alive = network(deployed(text, **LAMP)).processes["lamp"].alive
    found = alive and (alive.every, alive.within, alive.misses, alive.restarts, alive.worker)
    assert found == expected
    assert alive is None or alive.proxy.startswith("commonbehavior:tcp -h localhost -p ")


@pytest.mark.parametrize(
    ("given", "proxy"),
    [
        ("endpoints: {Laser: tcp -p 10003}", ""),
        ("endpoints: {Laser: tcp -p 10003}, alive: on", "laser:tcp -h localhost -p 10003"),
        (
            "endpoints: {Scan: udp -p 10004, Laser: tcp -p 10003}, alive: {every: 1 s}",
            "laser:tcp -h localhost -p 10003",
        ),
        ("endpoints: {Laser: tcp -p 10003}, alive: off", ""),
    ],
)
def test_a_program(given: str, proxy: str) -> None:
    """The keys of the document are for components."""
    alive = (
        network(deployed(f"alive: {{every: 1 s}}\ncomponents: {{laser: {{program: x, {given}}}}}\n"))
        .processes["laser"]
        .alive
    )
    assert (alive.proxy if alive else "") == proxy
    assert alive is None or alive.worker == FOREVER


@pytest.mark.parametrize("given", ["alive: on", "alive: {then: tell}", "alive: on, endpoints: {Scan: udp -p 10004}"])
def test_a_program_that_serves_nothing(given: str) -> None:
    (fault,) = faults(deployed(f"components: {{laser: {{program: x, {given}}}}}\n"))
    assert fault.code == "RC7050" and "`alive:` asks 'laser'" in fault.message
