"""RC7xxx: deploying. What keeps a network from starting, and what a user should know about one that runs.

Up to RC7019 what holds for every engine and for the local one.
"""

from __future__ import annotations

from robocomp_yaml.diag.code import Code


def _one(entry: str, head: str = "") -> dict[str, str | bytes | None]:
    """A deployment of one program; `entry` is what stands under its name."""
    lines = "".join(f"    {line}\n" for line in entry.splitlines())
    return {"robot.ddsl.yaml": f"deployment: Robot\n{head}components:\n  base:\n{lines}"}


_FINE = _one('program: "true"')
_UP = "deploy up robot.ddsl.yaml --attach"
_LISTENING = (
    "import socket, time; s = socket.create_server(('127.0.0.1', 14711)); print('up', flush=True); time.sleep(60)"
)

PORT_TAKEN = Code(
    "RC7001",
    "error",
    "'{name}' is to serve port {port}, which another program has: {program}",
    "Two programs cannot listen on one port of a machine, and the second one would end at once. The other program may "
    "be a component that was started by hand, or belong to another deployment. End it, or choose another port.",
    {
        "robot.ddsl.yaml": (
            "deployment: Robot\n"
            "components:\n"
            "  other:\n"
            "    program: python3\n"
            f'    args: [-c, "{_LISTENING}"]\n'
            "    ready: {log: up}\n"
            "  base:\n"
            '    program: "true"\n'
            "    after: [other]\n"
            "    endpoints: {Laser: tcp -p 14711}\n"
        )
    },
    _FINE,
    _UP,
)
REFUSED = Code(
    "RC7002",
    "error",
    "'{name}' cannot be {what}: {reason}",
    "The operating system refused, for the reason that is given: there is no such program or folder, the file is not "
    "executable, or it is no program of this kind of machine.",
    _one('program: "true"\nenv: {PATH: /nowhere}'),
    _FINE,
    _UP,
)
NOT_READY = Code(
    "RC7003",
    "error",
    "'{name}' was not ready within {within} s: {why}",
    "What depends on a process is started only when the process is ready: its interfaces answer a ping, or what "
    "`ready:` says holds. The last lines of its log, which are shown, often say what it waits for. A slow one needs "
    "more time: `ready: 60 s`.",
    _one('program: sleep\nargs: ["60"]\nready: {port: 14712, within: 0.2 s}'),
    _one('program: echo\nargs: [here I am]\nready: {log: here}'),
    _UP,
)
ENDED_EARLY = Code(
    "RC7004",
    "error",
    "'{name}' ended before it was ready: {how}",
    "The process ended, and was started again as often as its `restart:` allows. The last lines of its log, which are "
    "shown, often say why.",
    _one('program: "false"\nrestart: "no"'),
    _FINE,
    _UP,
)
FOLDER = Code(
    "RC7005",
    "error",
    "cannot work in '{path}': {reason}",
    "All that a deployment writes (derived configurations, logs, what it must remember) stands in a folder of its own, "
    "`.rcyaml/deployments/NAME` beside the document. Only one rcyaml changes a deployment at a time.",
    {**_one('program: "true"'), ".rcyaml/deployments": "a file where a folder must be\n"},
    _FINE,
    _UP,
)
UNSET_VARIABLE = Code(
    "RC7006",
    "error",
    "'{name}' takes a variable from your environment that is not set: {variable}",
    "`{env: NAME}` under `env:` gives a process the value that a variable has where `rcyaml deploy up` is called, so "
    "that a password need not stand in a document. Set it there.",
    _one('program: "true"\nenv: {PASSWORD: {env: RCYAML_EXAMPLE_PASSWORD}}'),
    _FINE,
    _UP,
)
SUPERVISOR_KILLED = Code(
    "RC7007",
    "warning",
    "the supervisor of this deployment was killed, and all that it ran with it",
    "Each deployment that runs on this machine has a supervisor, to which its processes are tied: when someone kills "
    "it, or the machine was switched off, nothing is left running unwatched. `rcyaml deploy up` starts the deployment "
    "again.",
    {**_one('program: "true"'), ".rcyaml/deployments/Robot/state/supervisor": "1 0\n"},
    _FINE,
    "deploy status robot.ddsl.yaml",
)
NOT_HERE = Code(
    "RC7008",
    "error",
    "'{name}' belongs on the host '{host}' ({address}), which is not this machine",
    "The engine `local` runs everything on the machine where it is called. Several machines need the engine `icegrid`, "
    "which is taken by itself where a deployment has more than one host.",
    _one('program: "true"', "hosts:\n  arm: {address: 192.0.2.7}\n"),
    _FINE,
    "deploy up robot.ddsl.yaml --engine local --attach",
)
GIVEN_UP = Code(
    "RC7009",
    "error",
    "'{name}' was given up: {how}",
    "A process that ended by itself is started again after a delay that doubles each time, by what `restart:` says, "
    "but never for ever: when it ends more often than `tries` within `within`, it is given up, and `rcyaml deploy up` "
    "tries again. Its log (`rcyaml deploy logs`) says why it ended.",
    _one('program: sh\nargs: [-c, "sleep 0.3; exit 3"]\nrestart: {policy: on-failure, tries: 1, delay: 0.01 s}'),
    _FINE,
    _UP,
)
LATE = Code(
    "RC7011",
    "error",
    "the time limit of {within} s was over {when}",
    "`--timeout` says how long `rcyaml deploy up` may take, all in all. When that time is over, nothing more is "
    "started, each process that was waited for is told with what it lacked, and `--on-failure` says what becomes of "
    "those that were started. A network that takes longer in good order needs more time, or none of its own: without "
    "`--timeout`, each process has the time of its `ready:`.",
    _one('program: sleep\nargs: ["60"]\nready: {port: 14713, within: 60 s}'),
    _FINE,
    f"{_UP} --timeout 3s",
)
_COMPILED: dict[str, str | bytes | None] = {
    "robot.ddsl.yaml": "deployment: Robot\ncomponents:\n  mouth: {component: mouth}\n",
    "Mouth.idsl.yaml": "module: RoboCompMouth\ninterfaces:\n  Mouth:\n    methods:\n      open:\n",
    "mouth/mouth.cdsl.yaml": "component: MouthComp\nlanguage: python\nimports: [../Mouth]\nimplements: [Mouth]\n",
    "mouth/bin/MouthComp": "-> /bin/true",
}
OUTDATED = Code(
    "RC7012",
    "warning",
    "'{name}' was compiled before {document} changed",
    "What is called is what was compiled: a component that was not compiled since its interface changed fails the "
    "calls of those that were, or misunderstands them. Compile all that are to speak with each other.",
    {**_COMPILED, "mouth/slice/Mouth.ice": "// an earlier one\n"},
    _COMPILED,
    "deploy plan robot.ddsl.yaml",
)
NO_ANSWER = Code(
    "RC7010",
    "error",
    "the host '{host}' ({address}) cannot be asked: {reason}",
    "What another machine has is asked over ssh, which must let you in without a question: with a key, and a host that "
    "it knows. `ssh ADDRESS true` shows whether it does.",
    _one('program: "true"', "hosts:\n  arm: {address: nowhere.invalid}\n"),
    _FINE,
    "deploy probe robot.ddsl.yaml",
)
