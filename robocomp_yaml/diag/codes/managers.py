"""RC5xxx: what `rcyaml migrate` says about RCManager's networks and about launchers."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.diagnostic import NOTE, WARNING

_LASER = (
    '<rcmanager>\n <node alias="laser" endpoint="laser:tcp -h localhost -p 10003">\n'
    '  <upCommand command="rcremote localhost laser /opt/laser ./bin/laser etc/config" />\n </node>\n'
)
_BASE = (
    ' <node alias="base" endpoint="omnirobot:tcp -h localhost -p 10004">\n  <dependence alias="laser" />\n'
    '  <upCommand command="rcremote localhost base /opt/base ./bin/base etc/config" />\n </node>\n'
)
_RIGHT: dict[str, str | bytes | None] = {"robot.xml": f"{_LASER}{_BASE}</rcmanager>\n"}
_MIGRATE = "migrate robot.xml"


def _wrong(old: str, new: str) -> dict[str, str | bytes | None]:
    return {"robot.xml": f"{_LASER}{_BASE}</rcmanager>\n".replace(old, new)}


DANGLING = Code(
    "RC5033", WARNING, "'{name}' depends on '{other}', which is not in this network",
    "RCManager passed over dependences on nodes that are not there. A deployment cannot wait for what it does not "
    "start: the name is kept under `x-rcmanager:`, where the exporter finds it.",
    _wrong('dependence alias="laser"', 'dependence alias="lidar"'), _RIGHT, _MIGRATE,
)  # fmt: skip
NOT_STARTED = Code(
    "RC5034", WARNING, "nothing starts '{name}': {reason}",
    "A node without a command is started by something else, or by hand, and a deployment has no place for it. All that "
    "the file says of it is kept under `x-rcmanager:`; nothing waits for it.",
    _wrong("rcremote localhost laser /opt/laser ./bin/laser etc/config", ""), _RIGHT, _MIGRATE,
)  # fmt: skip
ODD_ENDPOINT = Code(
    "RC5035", WARNING, "{problem}",
    "An endpoint says where a node answers: `laser:tcp -h localhost -p 10003`, Ice's identity and an address of the "
    "host where its command runs. The document says where the command runs; what the file says is kept for exporters.",
    _wrong("laser:tcp -h localhost -p 10003", "laser:tcp -h 10.0.0.9 -p 10003"), _RIGHT, _MIGRATE,
    says=(
        "the endpoint of '{name}' is no address with a port, so nothing says where it answers",
        "'{name}' is started on {host}, but its endpoint is on {other}",
        "'{name}' answers as '{interface}', which {component} does not implement",
    ),
)  # fmt: skip
NEEDS_SHELL = Code(
    "RC5036", WARNING, "the command of '{name}' is for a shell, so `sh -c` runs it",
    "A deployment starts programs without a shell, so that names and arguments mean what they say. A command with "
    "pipes, variables or several programs works as before, through a shell of its own. Better is a program, `args:`, "
    "`cwd:` and `env:`.",
    _wrong("./bin/laser etc/config", "./bin/laser etc/config &gt; log"), _RIGHT, _MIGRATE,
)  # fmt: skip
SAME_PROCESS = Code(
    "RC5037", NOTE, "'{name}' has the command of '{other}': it is a second name of that process",
    "Several nodes of a manager may stand for one process that serves several interfaces. The document starts it once: "
    "`process:` gives it another name.",
    _wrong("rcremote localhost base /opt/base ./bin/base etc/config",
           "rcremote localhost laser /opt/laser ./bin/laser etc/config"), _RIGHT, _MIGRATE,
)  # fmt: skip
NO_PROGRAM = Code(
    "RC5038", WARNING, "the command of '{name}' starts '{word}', which is a configuration file",
    "A command is `rcremote HOST TAB FOLDER PROGRAM ARGUMENTS`. Where the folder is missing, the program is "
    "taken for it, and its first argument for the program.",
    _wrong("rcremote localhost laser /opt/laser ./bin/laser etc/config",
           "rcremote localhost laser /opt/laser/bin/laser /opt/laser.conf"), _RIGHT, _MIGRATE,
)  # fmt: skip
