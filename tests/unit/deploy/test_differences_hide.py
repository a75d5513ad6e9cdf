"""The differences in a plan, without secrets."""

from __future__ import annotations

from robocomp_yaml.deploy.differences import differences
from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.network.network import ConfigFile, EnvironmentVariable, Process, Readiness


def spec(secret: str) -> ProcessSpec:
    command = ("/bin/x", f"--wifi={secret}", "--password", secret, f"http://bob:{secret}@host", "--name=x")
    process = Process(
        "x", "here", command, "/", env=(EnvironmentVariable("TOKEN", secret), EnvironmentVariable("DB", f"x://u:{secret}@h")),
        config=ConfigFile(
            "config/x", f"wifi={secret}\nlock={secret}\nmail.password={secret}\nname={len(secret)}\n", ("lock",)
        ),
        ready=Readiness(command=("ask", f"--api-key={secret}")), secrets=("wifi",),
    )  # fmt: skip
    return ProcessSpec(process, "", command, "/config/x")


def test_secrets_are_hidden() -> None:
    told = [str(one) for one in differences(spec("canary"), spec("canaryNew"))]
    assert not [line for line in told if "canary" in line]
    hidden = "/bin/x --wifi=*** --password *** http://bob:***@host --name=x"
    assert told == [
        f"command: {hidden} → {hidden}", "env TOKEN: *** → ***", "env DB: x://u:***@h → x://u:***@h",
        "config wifi: *** → ***", "config lock: *** → ***", "config mail.password: *** → ***", "config name: 6 → 9",
        "ready.command: ask --api-key=*** → ask --api-key=***",
    ]  # fmt: skip
