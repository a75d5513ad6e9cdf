"""The examples of `--help`: for each command, what one would type, and what it does. All are about the robot of the
tutorial: components BaseComp and PatrolComp, their interface Base and topic Odometry, and the deployment Patrol with
its entries base and patrol."""

from __future__ import annotations

EXAMPLES: dict[str, tuple[tuple[str, str], ...]] = {
    "init": (("init robot", "a workspace with an example"), ("init --bare", "this folder, without one")),
    "new interface": (("new interface Camera Arm", "two documents, each with an interface"),),
    "new component": (
        ("new component ArmComp --requires Base", "in Python"),
        ("new component ArmComp --language cpp --publishes Odometry", "in C++"),
    ),
    "new parameters": (("new parameters BaseComp", "beside the document of BaseComp"),),
    "new deployment": (("new deployment Robot", "of all components of the workspace"),),
    "check": (
        ("check", "all documents below this folder"),
        ("check --fix components/patrolcomp", "and repair what is certain"),
        ("check --fail-on warning", "in CI"),
    ),
    "fmt": (("fmt", "all documents below this folder"), ("fmt --check", "in CI: write nothing")),
    "compile": (
        ("compile", "all documents below this folder"),
        ("compile --diff", "see what would change"),
        ("compile --merge", "also add missing methods to your code"),
    ),
    "build": (
        ("build", "what is not up to date"),
        ("build PatrolComp --type debug", "one component, for a debugger"),
    ),
    "run": (
        ("run PatrolComp --with-needed", "and the base beside it"),
        ("run patrol --set speed=0.3", "an entry, with another value"),
        ("run patrol --dry-run", "only show command and values"),
    ),
    "call": (
        ("call base.Base.position", ""),
        ("call base.Base.drive speed=0.5", "an argument by its name"),
        ("call 192.168.7.3:10001.Base.position", "without a deployment"),
    ),
    "param list": (("param list patrol", ""),),
    "param get": (("param get patrol speed", ""),),
    "param set": (
        ("param set patrol speed 0.6", "until it ends"),
        ("param set patrol speed 0.6 --save", "and for the next start"),
    ),
    "param watch": (("param watch patrol speed", "each change, until Ctrl-C"),),
    "topic list": (("topic list", "of the deployment of this workspace"),),
    "topic echo": (
        ("topic echo Odometry", "until Ctrl-C"),
        ("topic echo Odometry.moved --count 1 --format json", "one, as JSON"),
    ),
    "topic hz": (("topic hz Odometry --for 10s", "the rate over ten seconds"),),
    "topic pub": (
        ("topic pub Odometry.moved position=0.5", "one message"),
        ("topic pub Odometry.moved position=0.5 --rate 10", "until Ctrl-C"),
    ),
    "top": (
        ("top", "until q"),
        ("top --sort cpu", "what uses most comes first"),
        ("top --once --format json", "one sample, for programs"),
    ),
    "record": (
        ("record -o drive.mcap", "all topics, until Ctrl-C"),
        ("record info drive.mcap", "what is in it"),
        ("record play drive.mcap", "publish it again"),
    ),
    "record start": (("record start Odometry --for 1min -o drive.mcap", ""),),
    "record info": (("record info drive.mcap", ""),),
    "record play": (
        ("record play drive.mcap", "all topics"),
        ("record play drive.mcap Odometry --rate 2", "one topic, twice as fast"),
    ),
    "mock": (
        ("mock Base", "answers wherever components expect Base"),
        ("mock --script base.mock.yaml", "with the answers of a script"),
    ),
    "migrate": (
        ("migrate --dry-run .", "see what would be written"),
        ("migrate .", "documents beside all legacy files"),
        ("migrate speech.cdsl -I ~/robocomp/interfaces", ""),
    ),
    "config new": (("config new BaseComp", "all parameters, as comments"),),
    "config check": (("config check components/patrolcomp/etc/config.yaml", ""),),
    "config show": (("config show PatrolComp", "each value, and what sets it"),),
    "config get": (("config get PatrolComp speed", ""),),
    "config set": (("config set PatrolComp speed 0.6", ""), ("config set PatrolComp speed null", "its default")),
    "config export": (("config export PatrolComp --as toml", ""),),
    "edit connect": (
        ("edit connect patrol Base base", "to an entry"),
        ('edit connect patrol Base "base:tcp -h 10.0.0.9 -p 10002"', ""),
    ),
    "edit disconnect": (("edit disconnect patrol Base", "the connection is derived again"),),
    "edit topic": (("edit topic base Odometry LeftOdometry", "another name in IceStorm"),),
    "edit move": (("edit move base onboard", ""),),
    "edit add-host": (
        ("edit add-host laptop 192.168.7.2", ""),
        ("edit add-host onboard 192.168.7.3 --user robot", "with an ssh login"),
    ),
    "edit remove-host": (("edit remove-host spare", ""),),
    "edit group": (("edit group driving base patrol", ""),),
    "edit ungroup": (("edit ungroup all patrol", "one member"), ("edit ungroup all", "the group")),
    "edit add": (
        ("edit add other components/patrolcomp", "once more"),
        ("edit add camera CameraComp --new --requires Base", "a new one"),
        ("edit add bag --program -- rosbag record -a", "any program"),
    ),
    "edit remove": (("edit remove patrol", ""),),
    "edit rename": (("edit rename patrol guard", ""),),
    "edit set": (("edit set patrol speed 0.6", ""),),
    "edit unset": (("edit unset patrol way", ""),),
    "edit port": (("edit port base 10001", ""), ("edit port base none", "a derived one again")),
    "edit instances": (("edit instances patrol 3", "patrol0 to patrol2"),),
    "edit after": (("edit after base storm", ""),),
    "edit not-after": (("edit not-after patrol base", ""),),
    "edit implement": (("edit implement PatrolComp Base", ""),),
    "edit unimplement": (("edit unimplement PatrolComp Base", ""),),
    "edit require": (("edit require PanelComp Base", ""),),
    "edit unrequire": (("edit unrequire PatrolComp Base", ""),),
    "edit publish": (("edit publish PatrolComp Odometry", ""),),
    "edit unpublish": (("edit unpublish BaseComp Odometry", ""),),
    "edit subscribe": (("edit subscribe BaseComp Odometry", ""),),
    "edit unsubscribe": (("edit unsubscribe PatrolComp Odometry", ""),),
    "edit place": (("edit place base 40 120", ""), ("edit place base", "the picture decides again")),
    "edit undo": (("edit undo", "the last change of the deployment"),),
    "edit redo": (("edit redo", ""),),
    "rename": (
        ("rename Base.position place --diff", "see what would change"),
        ("rename patrol guard", "an entry"),
        ("rename interfaces/Base.idsl.yaml:7:3 Platform", "what is at a location"),
    ),
    "graph": (("graph", ""), ("graph --as svg -o robot.svg", "a picture")),
    "deploy plan": (("deploy plan", ""), ("deploy plan base", "one process")),
    "deploy up": (
        ("deploy up", "start, and apply changes"),
        ("deploy up --build --attach", "build first; print the logs until Ctrl-C"),
        ("deploy up base", "one process, with what it needs"),
    ),
    "deploy status": (("deploy status", ""), ("deploy status Patrol --format json", "by name, from any folder")),
    "deploy ls": (("deploy ls", ""),),
    "deploy logs": (
        ("deploy logs -f", "all, until Ctrl-C"),
        ("deploy logs patrol --since 5min --grep error", ""),
    ),
    "deploy restart": (("deploy restart base", "one process"),),
    "deploy rollback": (("deploy rollback", ""),),
    "deploy down": (("deploy down", ""), ("deploy down Patrol", "by name, from any folder")),
    "deploy push": (("deploy push --dry-run", "see what would be sent"), ("deploy push", "")),
    "deploy install": (("deploy install --print", "see the units"), ("deploy install", "")),
    "deploy uninstall": (("deploy uninstall", ""),),
    "deploy probe": (("deploy probe", "all hosts"),),
    "deploy export": (("deploy export --as systemd -o units", ""), ("deploy export --as compose", "print it")),
    "manager": (
        ("manager", "opens a browser"),
        ("manager --read-only --no-browser --port 8000", "only look"),
    ),
    "lsp": (("lsp", "an editor starts it"),),
    "schema": (
        ("schema ddsl", "the schema of deployments"),
        ("schema deployments/patrol.ddsl.yaml", "which one applies to a file"),
    ),
    "explain": (("explain RC2003", ""), ("explain", "all diagnostics")),
}
"""By the names of the commands, without `rcyaml`."""


def examples_of(path: str) -> list[str]:
    """The examples of a command, such as `rcyaml deploy up`, as lines for a shell."""
    found = [(f"rcyaml {typed}", meaning) for typed, meaning in EXAMPLES.get(path.partition(" ")[2], ())]
    width = max((len(typed) for typed, meaning in found if meaning), default=0)
    return [f"{typed:<{width}}  # {meaning}" if meaning else typed for typed, meaning in found]
