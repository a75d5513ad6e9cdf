"""How a deployment is shown: what needs no process to be seen."""

from __future__ import annotations

from networks import speaking

from robocomp_yaml.commands._deploy_views import status_text
from robocomp_yaml.deploy.operations import Status


def test_a_table_of_states_fits_its_terminal() -> None:
    network = speaking()
    found = [Status(process.name, process.host, False) for process in network.enabled()]
    whole = status_text(network, found, False)
    assert "Laser:10003, DifferentialRobot:10004" in whole
    narrow = status_text(network, found, False, 80).splitlines()
    assert max(map(len, narrow)) == 80 and any("Laser:10003, Dif" in line and line.endswith("…") for line in narrow)
    assert status_text(network, found, False, 200) == whole
    assert "  Laser…" in status_text(network, found, False, 10)  # no narrower than the column's head
