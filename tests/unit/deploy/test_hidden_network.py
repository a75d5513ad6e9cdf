"""A hidden network contains no secret."""

from __future__ import annotations

import msgspec

from engine_in_memory import network, process
from robocomp_yaml.deploy.exported import hidden
from robocomp_yaml.network.network import ConfigFile, EnvironmentVariable, Readiness

CANARY = "canary-hunter2"


def test_secrets_are_hidden_and_nothing_else() -> None:
    one = process(
        "camera",
        env=(
            EnvironmentVariable("TOKEN", CANARY),
            EnvironmentVariable("LANG", "es"),
            EnvironmentVariable("WIFI", CANARY),
        ),
        config=ConfigFile(
            "config/camera", f"# of it\nport=7\napi.password={CANARY}\nwifi={CANARY}\nlock={CANARY}\n", ("lock",)
        ),
        ready=Readiness(command=("ask", f"--api-key={CANARY}", "--name=x")),
        secrets=("wifi", "WIFI"),
        extra=(
            ("password", CANARY),
            ("x", {"token": CANARY, "y": ["z", {"secret": CANARY}], "n": 5}),
            ("passwords", [CANARY]),
        ),
    )
    one = msgspec.structs.replace(one, command=("run", "--password", CANARY, f"--wifi={CANARY}", "--name=camera"))
    extra = (("general", {"password": CANARY, "editor": "vim", "since": 2011}),)
    made = msgspec.structs.replace(network(one), extra=extra)
    shown = hidden(made)
    assert CANARY not in str(shown)
    camera = shown.processes["camera"]
    assert camera.command == ("run", "--password", "***", "--wifi=***", "--name=camera")
    assert [(each.name, each.value) for each in camera.env] == [("TOKEN", "***"), ("LANG", "es"), ("WIFI", "***")]
    assert camera.config and camera.config.text == "# of it\nport=7\napi.password=***\nwifi=***\nlock=***\n"
    assert camera.ready.command == ("ask", "--api-key=***", "--name=x")
    assert camera.extra[1] == ("x", {"token": "***", "y": ["z", {"secret": "***"}], "n": 5})
    assert shown.extra == (("general", {"password": "***", "editor": "vim", "since": 2011}),)
    assert hidden(network(process("plain"))).processes["plain"].config is None
