"""What is derived for a network, as Ice reads it: every property, every endpoint, every proxy."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from conftest import write_tree
from deployments import deployed
from processes import Ports
from robocomp_yaml.network.network import Network, Process
from robocomp_yaml.pipeline import analyse

Ice = pytest.importorskip("Ice")

HOSTS = ("", "hosts: {a: 127.0.0.2, b: 127.0.0.3}\n", 'hosts: {a: "fd00::2", b: robot.local}\n')
numbers = st.integers(1024, 65535)


def network(folder: Path, text: str, config: str) -> Network:
    values = {"etc/config.yaml": "component: ../speech.cdsl.yaml\nproxies: {Mouth: 'mouth:tcp -p 1'}\n"}
    flat = {"etc/config": 'Endpoints.Speech = "tcp -p 1"\nMouthProxy = mouth:tcp -p 2\n# no more'}
    files = {"values": values, "flat": flat, "none": {}}[config]
    lists = "implements: [Speech]\nrequires: [Mouth]\npublishes: [Heard]\nsubscribes: [Heard]\n"
    write_tree(folder, deployed(text, speech=lists, **{f"speech/{path}": body for path, body in files.items()}))
    analysis = analyse([str(folder / "robot.ddsl.yaml")])
    assert not [fault for fault in analysis.diagnostics if fault.severity == "error"], analysis.diagnostics
    return analysis.networks[os.path.realpath(folder / "robot.ddsl.yaml")]


def loaded(process: Process, folder: Path) -> Ice.Properties:
    assert process.config is not None
    path = folder / f"{process.name}.config"
    path.write_text(process.config.text, encoding="utf-8")
    properties = Ice.createProperties()
    properties.load(str(path))
    return properties


@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    hosts=st.sampled_from(HOSTS),
    config=st.sampled_from(["values", "flat", "none"]),
    ports=st.lists(numbers, min_size=3, max_size=3, unique=True),
    names=st.permutations(["x", "y-1", "z_2"]),
)
def test_ice_reads_what_was_derived(
    tmp_path: Path, hosts: str, config: str, ports: list[int], names: list[str]
) -> None:
    speech, mouth, _ = names
    on = [", host: a", ", host: b"] if hosts else ["", ""]
    given = {"values": "", "flat": ", config: etc/config", "none": ""}[config]
    folder = tmp_path / config
    (folder / "speech/etc/config.yaml").unlink(missing_ok=True)
    found = network(
        folder,
        (
            f"{hosts}services: {{storm: {{icestorm: {{port: {ports[2]}{on[1]}}}}}}}\ncomponents:\n"
            f"  {speech}: {{component: speech, port: {ports[0]}{on[0]}{given}}}\n"
            f"  {mouth}: {{component: mouth, port: {ports[1]}{on[1]}}}\n"
        ),
        config,
    )
    communicator = Ice.initialize()
    try:
        for process in found.processes.values():
            properties = loaded(process, folder)
            for endpoint in process.endpoints:
                prefix = "IceStorm." if process.name == "storm" else ""
                assert properties.getProperty(f"{prefix}{endpoint.interface}.Endpoints") == endpoint.text
            for ping in process.ready.pings:
                assert communicator.stringToProxy(ping) is not None
        properties = loaded(found.processes[speech], folder)
        proxy = communicator.stringToProxy(properties.getProperty("MouthProxy"))
        (endpoint,) = (one.getInfo() for one in proxy.ice_getEndpoints())
        host = found.hosts[found.processes[mouth].host].address
        info = endpoint
        while info.underlying:
            info = info.underlying
        assert (proxy.ice_getIdentity().name, info.host, info.port) == ("mouth", host, ports[1])
        manager = communicator.stringToProxy(properties.getProperty("TopicManager.Proxy"))
        identity = manager.ice_getIdentity()
        assert (identity.category, identity.name) == ("IceStorm", "TopicManager")
    finally:
        communicator.destroy()


def test_an_adapter_listens_where_it_is_configured(tmp_path: Path, free_port: Ports) -> None:
    port = free_port()
    found = network(
        tmp_path,
        (
            f"services: {{storm: {{icestorm: {{}}}}}}\ncomponents:\n  speech: {{component: speech, port: {port}}}\n"
            "  mouth: {component: mouth}\n"
        ),
        "none",
    )
    process = found.processes["speech"]
    data = Ice.InitializationData()
    data.properties = loaded(process, tmp_path)
    communicator = Ice.initialize(data)
    try:
        adapter = communicator.createObjectAdapter("Speech")
        (endpoint,) = adapter.getEndpoints()
        assert f"-h 127.0.0.1 -p {port}" in endpoint.toString()
    finally:
        communicator.destroy()
