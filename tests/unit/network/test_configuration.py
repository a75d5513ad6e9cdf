"""The configuration of a process: based on values documents and on flat configs, with the values of `set:`, which are
checked."""

from __future__ import annotations

from pathlib import Path

import pytest

from conftest import write_tree
from deployments import analysed, config, deployed, faults, network, said

BOTH = "components:\n  speech: {component: speech, port: 10001MORE}\n  mouth: {component: mouth, port: 10002}\n"
PDSL = """\
component: speech.cdsl.yaml
types:
  Motor: {struct: {name: string, vel: {type: float, range: [0, 2], default: 0.9}}}
parameters:
  volume: {type: int, range: [0, 100], default: 50}
  voice: {group: {pitch: {type: float, default: 1}}}
  motors: {list: Motor, default: [{name: left}, {name: right, vel: 1}]}
  gains: {map: float, default: {}}
"""
VALUES = "component: ../speech.cdsl.yaml\n"


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def files(more: str = "", **others: str) -> dict[str, str | bytes | None]:
    return dict(deployed(BOTH.replace("MORE", more), **{"speech/speech.pdsl.yaml": PDSL}, **others))


def speech(more: str = "", **others: str) -> dict[str, str]:
    """The properties of `speech`; `others` are further files."""
    return config(network(files(more, **others)).processes["speech"])


def test_without_a_document_there_are_defaults_and_derived_properties() -> None:
    found = speech()
    assert found["Speech.Endpoints"] == "tcp -h 127.0.0.1 -p 10001"
    assert found["MouthProxy"] == "mouth:tcp -h localhost -p 10002"
    assert found["volume"] == "50" and found["motors.size"] == "2" and "CommonBehavior.Endpoints" in found


def test_derived_properties_replace_those_of_the_document() -> None:
    values = VALUES + (
        "parameters: {volume: 7}\nendpoints: {Speech: tcp -p 1, CommonBehavior: tcp -p 2}\n"
        'proxies: {Mouth: "mouth:tcp -p 3"}\nice: {Warn.Connections: "1"}\nproperties: {Own: "5"}\n'
    )
    found = speech(**{"speech/etc/config.yaml": values})
    assert found["Speech.Endpoints"] == "tcp -h 127.0.0.1 -p 10001" and found["volume"] == "7"
    assert found["MouthProxy"] == "mouth:tcp -h localhost -p 10002"
    assert found["Ice.Warn.Connections"] == "1" and found["Own"] == "5"


def test_the_document_that_config_names() -> None:
    values = {
        "speech/etc/config.yaml": VALUES + "parameters: {volume: 7}\n",
        "speech/etc/loud.config.yaml": "extends: [config.yaml]\nparameters: {voice: {pitch: 2}}\n",
    }
    found = speech(", config: etc/loud.config.yaml", **values)
    assert (found["volume"], found["voice.pitch"]) == ("7", "2")


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ("{volume: 70}", {"volume": "70", "voice.pitch": "1"}),
        ("{voice: {pitch: 2}}", {"voice.pitch": "2", "volume": "7"}),
        ("{voice.pitch: 2}", {"voice.pitch": "2"}),
        ('{"motors[1].vel": 2}', {"motors.0.vel": "0.5", "motors.1.vel": "2", "motors.1.name": "b"}),
        ('{"motors[0].vel": 1, "motors[1].name": c}', {"motors.0.vel": "1", "motors.1.name": "c"}),
        ("{motors: [{name: x}]}", {"motors.size": "1", "motors.0.name": "x", "motors.0.vel": "0.9"}),
        ('{gains.a: 1, "gains[\\"b c\\"]": 2}', {"gains.a": "1", "gains.b%20c": "2"}),
        ("{volume: null}", {"volume": "50"}),
        ("{period.compute: 20}", {"period.compute": "20"}),
        ("{volume: {env: LOUD}}", {"volume": "${env:LOUD}"}),
    ],
)
def test_what_the_deployment_sets(given: str, expected: dict[str, str]) -> None:
    values = VALUES + "parameters:\n  volume: 7\n  motors: [{name: a, vel: 0.5}, {name: b, vel: 1}]\n"
    found = speech(f", set: {given}", **{"speech/etc/config.yaml": values})
    assert {key: found.get(key) for key in expected} == expected


def test_a_wrong_path_is_reported_with_its_reason() -> None:
    (found,) = faults(files(", set: {period.compute: 0, voice.pitch: 1}"))
    assert found.message.startswith("period.compute is 0 ms")
    (found,) = faults(files(", set: {voice.pich: 1}"))
    assert found.message == "unknown parameter 'voice.pich'" and found.hint == "did you mean 'pitch'?"


def test_each_instance_has_its_own_configuration() -> None:
    found = network(
        deployed(
            'components: {"m{i}": {component: idle, instances: 2, set: {name: "cam{i}"}}}\n',
            idle="",
            **{"idle/idle.pdsl.yaml": "component: idle.cdsl.yaml\nparameters: {name: string}\n"},
        )
    )
    assert [config(process)["name"] for process in found.processes.values()] == ["cam0", "cam1"]


@pytest.mark.parametrize(
    ("given", "code", "column"),
    [
        ("{volume: 101}", "RC3303", 58),
        ("{volume: loud}", "RC3302", 58),
        ("{volumee: 1}", "RC3301", 50),
        ('{"motors[1].vel": 7}', "RC3303", 67),
        ('{"motors[2].vel": 1}', "RC4307", 50),
        ('{"volume[0]": 1}', "RC3302", 50),
        ('{"voice.depth": 1}', "RC3301", 50),
    ],
)
def test_a_wrong_value_is_reported_at_its_location(given: str, code: str, column: int) -> None:
    found = faults(files(f", set: {given}"))
    assert [said(fault) for fault in found] == [(code, "robot.ddsl.yaml", 3, column)]


def test_a_required_parameter_without_a_value() -> None:
    (found,) = faults(
        deployed(
            "components:\n  a: {component: idle}\n",
            idle="",
            **{"idle/idle.pdsl.yaml": "component: idle.cdsl.yaml\nparameters: {device: string}\n"},
        )
    )
    assert said(found) == ("RC3307", "robot.ddsl.yaml", 3, 3)


FLAT = "# as it was\nvolume = 7   # loud\nSpeech.Endpoints=tcp -p 1\nOwn = x y\nMouthProxy=mouth:tcp -p 3"


def test_a_flat_config_stays_unchanged_above_the_derived_properties() -> None:
    found = network(files(", config: etc/config, set: {volume: 70}", **{"speech/etc/config": FLAT}))
    text = found.processes["speech"].config
    assert text is not None and text.text.startswith(FLAT + "\n\n# Configuration of speech, derived by rcyaml from ")
    settings = config(found.processes["speech"])
    assert settings["Speech.Endpoints"] == "tcp -h 127.0.0.1 -p 10001" and settings["Own"] == "x y"
    assert settings["MouthProxy"] == "mouth:tcp -h localhost -p 10002" and settings["volume"] == "70"
    assert "motors.size" not in settings


def test_a_flat_config_in_the_other_dialect_gets_both_spellings() -> None:
    flat = 'Endpoints.Speech = "tcp -p 1"\nProxies.Mouth = "mouth:tcp -p 3"\nvolume = 7\n'
    found = speech(", config: etc/config", **{"speech/etc/config": flat})
    assert found["Endpoints.Speech"] == '"tcp -h 127.0.0.1 -p 10001"'
    assert found["Speech.Endpoints"] == "tcp -h 127.0.0.1 -p 10001"
    assert found["Proxies.Mouth"] == '"mouth:tcp -h localhost -p 10002"'


def test_values_of_the_other_dialect_get_both_spellings() -> None:
    values = VALUES + "legacy: {file: config, dialect: flat-toml}\nparameters: {volume: 7}\n"
    found = speech(**{"speech/etc/config.yaml": values})
    assert found["Endpoints.Speech"] == '"tcp -h 127.0.0.1 -p 10001"'
    assert found["Speech.Endpoints"] == "tcp -h 127.0.0.1 -p 10001" and "motors.size" not in found


def test_a_proxy_under_a_name_of_its_own() -> None:
    values = VALUES + 'proxies: {Mouth: {proxy: "mouth:tcp -p 3", key: navigation}}\n'
    assert speech(**{"speech/etc/config.yaml": values})["navigation"] == "mouth:tcp -h localhost -p 10002"


def test_set_on_a_flat_config_is_checked() -> None:
    (found,) = faults(files(", config: etc/config, set: {volume: 101}", **{"speech/etc/config": FLAT}))
    assert said(found) == ("RC3303", "robot.ddsl.yaml", 3, 78)


def test_a_flat_config_is_among_the_files_that_were_read() -> None:
    analysis = analysed(files(", config: etc/config", **{"speech/etc/config": FLAT}))
    assert analysis.disk.contents["speech/etc/config"] == FLAT.encode()


@pytest.mark.parametrize(
    ("how", "command"),
    [
        ("config-as: --Ice.Config, ", ("rcis", "-f", "100", "--Ice.Config={config}")),
        ("config-as: argument, ", ("rcis", "{config}", "-f", "100")),
        ("", ("rcis", "-f", "100")),
    ],
)
def test_a_program(how: str, command: tuple[str, ...]) -> None:
    found = network(
        deployed(
            f"components:\n  laser: {{program: rcis, {how}args: [-f, 100], cwd: sim, "
            "env: {DISPLAY: ':0', KEY: {env: K}}, endpoints: {Laser: tcp -p 10003}}\n  base: {process: laser, endpoints: {Base: tcp -p 10004}}\n"
        )
    ).processes["laser"]
    assert found.command == command and found.cwd == str(Path("sim").absolute()) and found.aliases == ("base",)
    assert [(one.name, one.value, one.source) for one in found.env] == [("DISPLAY", ":0", ""), ("KEY", "", "K")]
    assert found.ready.port == 10003 and not found.ready.pings
    if how:
        assert config(found) == {"Laser.Endpoints": "tcp -p 10003", "Base.Endpoints": "tcp -p 10004"}
    else:
        assert found.config is None


def test_a_program_gets_its_own_file_unchanged() -> None:
    found = network(
        deployed(
            "components: {view: {program: viewer, config: view.json, args: [--all, '-c{config}']}}\n",
            **{"view.json": '{"size": 3}'},
        )
    ).processes["view"]
    assert found.command == ("viewer", "--all", "-c{config}") and not found.is_ice
    assert found.config is not None and found.config.text == '{"size": 3}'


def test_the_configuration_is_the_first_argument_of_a_component() -> None:
    found = network(files(", args: [--startup-check], executable: build/speech")).processes["speech"]
    assert found.command == (str(Path("speech/build/speech").absolute()), "{config}", "--startup-check")
    assert found.cwd == str(Path("speech").absolute())


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ("ready: 3 s", (3.0, True, None, (), "")),
        ("ready: {port: 10009, within: 20 s}", (20.0, False, 10009, (), "")),
        ("ready: {command: [ls, -l]}", (10.0, False, None, ("ls", "-l"), "")),
        ("ready: {log: started}", (10.0, False, None, (), "started")),
    ],
)
def test_readiness(given: str, expected: tuple[object, ...]) -> None:
    ready = network(files(f", {given}")).processes["speech"].ready
    assert (ready.within, bool(ready.pings), ready.port, ready.command, ready.log) == expected


def test_the_code_of_a_component_in_python_is_watched() -> None:
    write_tree(Path(), dict.fromkeys([
        "speech/src/specificworker.py", "speech/src/notes.txt", "speech/src/mainUI.ui",
        "speech/generated/runtime/main.py", "speech/slice/Face.ice",
    ], ""))  # fmt: skip
    watched = network(files()).processes["speech"].watched
    assert [str(Path(path).relative_to(Path.cwd())) for path in watched] == [
        "speech/bin/SpeechComp",
        "speech/generated/runtime/main.py",
        "speech/slice/Face.ice",
        "speech/src/mainUI.ui",
        "speech/src/specificworker.py",
    ]
