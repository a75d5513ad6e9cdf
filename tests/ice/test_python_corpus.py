"""Every real interface that compiles: a component that implements, requires, publishes and subscribes it runs."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from components import build
from conftest import CORPUS, needs_corpus
from processes import Ports, Storm
from robocomp_yaml import pipeline
from robocomp_yaml.cli import group
from robocomp_yaml.diag.diagnostic import ERROR
from robocomp_yaml.model.interface import Interface
from scenario import cdsl

pytestmark = [needs_corpus, pytest.mark.slow]

RUNNER = Path(__file__).parent / "run_components.py"


def lists(interfaces: tuple[Interface, ...]) -> dict[str, object]:
    """All kinds of ports for the interfaces; proxies have unique names."""
    names = [interface.name for interface in interfaces]
    return {
        "implements": names,
        "requires": [{f"Own{name}": {"interface": name, "absent": "ignore"}} for name in names],
        "publishes": [{f"Topic{name}": name} for name in names],
        "subscribes": [{f"Topic{name}": name} for name in names],
    }


@pytest.fixture
def components(tmp_path: Path, free_port: Ports, icestorm: Storm) -> dict[str, tuple[Path, int]]:
    """For each interface file without errors, a configured component, by the file's name; and the number of calls that
    it can make."""
    CliRunner().invoke(group, ["migrate", str(CORPUS / "idsl"), "-o", str(tmp_path / "idsl")])
    analysis = pipeline.analyse([str(tmp_path / "idsl")])
    faulty = {d.span.file for d in analysis.diagnostics if d.severity == ERROR}
    ports = [free_port() for _ in range(8)]
    found = {}
    for linked in analysis.program.modules.values():
        if any(scope.module.path in faulty or scope.unresolved for scope in linked.closure()):
            continue
        module = linked.module
        folder = tmp_path / "components" / module.stem
        folder.mkdir(parents=True)
        interfaces = module.all_interfaces
        methods = [method for interface in interfaces for method in interface.methods]
        found[module.stem] = folder, len(methods) + sum(method.can_be_published for method in methods)
        (folder / "x.cdsl.yaml").write_text(
            cdsl(f"X{len(found)}", imports=[module.stem], **lists(interfaces)), encoding="utf-8"
        )
        config = [f"TopicManager.Proxy={icestorm.manager}\nperiod.compute=1\n"]
        for interface, port in zip(interfaces, ports, strict=False):
            endpoint = f"tcp -h 127.0.0.1 -p {port}"
            config.append(f"{interface.name}.Endpoints={endpoint}\n")
            config.append(f"Own{interface.name}Proxy={interface.name.lower()}:{endpoint}\n")
            config.append(f"Topic{interface.name}Topic.Endpoints=tcp -h 127.0.0.1 -p 0\n")
        (folder / "etc").mkdir()
        (folder / "etc" / "config").write_text("".join(config), encoding="utf-8")
    return found


def test_all_of_them_run(components: dict[str, tuple[Path, int]], tmp_path: Path) -> None:
    assert len(components) > 120
    build({}, tmp_path / "components", tmp_path / "idsl")
    roots = [str(root) for root, _ in components.values()]
    told = subprocess.run(
        [sys.executable, RUNNER], input=json.dumps(roots), capture_output=True, text=True, timeout=300
    )
    assert told.returncode == 0, told.stderr
    answers = {root: (wrong, calls) for root, wrong, calls in map(json.loads, told.stdout.splitlines())}
    got = {stem: answers.get(str(root)) for stem, (root, _) in components.items()}
    assert got == {stem: ("", calls) for stem, (_, calls) in components.items()}
