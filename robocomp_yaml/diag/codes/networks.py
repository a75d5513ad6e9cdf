"""RC42xx to RC44xx: the network that a deployment comes to."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes.ddsl import _BOTH, _CHECK, _MOVES, _SPEAKS, _SPEECH, deployed

_RIGHT = deployed()
_OTHER_SPEECH = _SPEECH.replace("open:", "open: {in: {how: float}}")
_MOUTH = "component: MouthComp\nlanguage: python\nimports: [../Speech]\nimplements: [Mouth]\n"
_NEWS = "module: RoboCompNews\ntopics:\n  News:\n    methods:\n      told: {in: {what: string}}\n"
_TALKS = "component: SpeechComp\nlanguage: python\nimports: [../Speech, ../News]\nimplements: [Speech]\n"
_PUBLISHES = _TALKS + "publishes: [News]\n"
_SUBSCRIBES = _MOUTH.replace("]\ni", ", ../News]\ni") + "subscribes: [News]\n"
_STORM = "services: {storm: {icestorm: {}}}\n"


def _with(tree: dict[str, str | bytes | None], **files: str) -> dict[str, str | bytes | None]:
    """`speech` and `mouth` are the components' documents, other names those of interfaces."""
    paths = {"speech": "speech/speech.cdsl.yaml", "mouth": "mouth/mouth.cdsl.yaml"}
    return tree | {paths.get(name, f"{name}.idsl.yaml"): text for name, text in files.items()}


UNRESOLVED = Code(
    "RC4201",
    "error",
    "'{source}' requires {interface}, which nothing in this deployment serves",
    "What a component requires is served by another component of the deployment, by a program that has an endpoint of "
    "this name, or by something outside, which `connect:` names by its proxy. Interfaces are the same when their "
    "modules and definitions are, in whatever document they stand. With `absent: ignore` in the component's document "
    "this is a warning.",
    deployed("components:\n" + _SPEAKS),
    deployed("components:\n" + _SPEAKS.replace("h}", 'h, connect: {Mouth: "mouth:tcp -h 10.0.0.9 -p 10002"}}')),
    _CHECK,
)
AMBIGUOUS = Code(
    "RC4202",
    "error",
    "'{source}' requires {interface} as {port}, and several serve it: {candidates}",
    "A proxy that `connect:` says nothing of is connected to the one that serves its interface. Where several do, "
    "those of the same include or closed group come first; where that leaves several, `connect:` has to choose.",
    deployed(_BOTH + "  other: {component: mouth}\n"),
    deployed(_BOTH.replace("h}\n  m", "h, connect: {Mouth: mouth}}\n  m") + "  other: {component: mouth}\n"),
    _CHECK,
)
MISMATCH = Code(
    "RC4203",
    "error",
    "'{source}' and '{target}' do not mean the same by {interface}: {difference}",
    "Both ends of a connection must agree on the interface: its module, its methods, and every type in them. They may "
    "import different documents, as long as what these define is equal.",
    _with(_RIGHT, Other=_OTHER_SPEECH, mouth=_MOUTH.replace("Speech]", "Other]")),
    _with(_RIGHT, Other=_SPEECH, mouth=_MOUTH.replace("Speech]", "Other]")),
    _CHECK,
)
NOT_SERVED = Code(
    "RC4204",
    "error",
    "'{target}' does not serve {interface}",
    "`connect:` names an entry that serves the interface of the proxy, or, where it serves several, one of these: "
    "`mouth.Mouth`.",
    deployed("components:\n" + _SPEAKS.replace("h}", "h, connect: {Mouth: speech}}") + _MOVES),
    deployed("components:\n" + _SPEAKS.replace("h}", "h, connect: {Mouth: mouth.Mouth}}") + _MOVES),
    _CHECK,
)
NO_TARGET = Code(
    "RC4205",
    "error",
    "there is nothing called '{name}' to connect to",
    "`connect:` names an entry, an interface of one (`mouth.Mouth`), a group, something in an include (`arm.elbow`), "
    "or something outside by its proxy.",
    deployed("components:\n" + _SPEAKS.replace("h}", "h, connect: {Mouth: muoth}}") + _MOVES),
    deployed("components:\n" + _SPEAKS.replace("h}", "h, connect: {Mouth: mouth}}") + _MOVES),
    _CHECK,
)
CLOSED_GROUP = Code(
    "RC4206",
    "error",
    "'{target}' is inside of the group '{group}', which is closed",
    "A group with `as:` or `expose:` acts as one component: those outside are connected to the group, and reach what "
    "it exposes.",
    deployed(
        "components:\n" + _SPEAKS.replace("h}", "h, connect: {Mouth: mouth}}") + _MOVES
        + "groups:\n  face: {components: [mouth], expose: {Mouth: mouth}}\n"
    ),
    deployed(
        "components:\n" + _SPEAKS.replace("h}", "h, connect: {Mouth: face}}") + _MOVES
        + "groups:\n  face: {components: [mouth], expose: {Mouth: mouth}}\n"
    ),
    _CHECK,
)
NOT_ENABLED = Code(
    "RC4207",
    "warning",
    "'{source}' requires {interface}, which '{target}' serves, and '{target}' is not enabled",
    "An entry with `enabled: false` is not started, so those that wait for it wait until someone does.",
    deployed("components:\n" + _SPEAKS + _MOVES.replace("h}", "h, enabled: false}")),
    deployed("components:\n" + _SPEAKS + _MOVES),
    _CHECK,
)
NO_STORM = Code(
    "RC4208",
    "error",
    "'{source}' {does} {topic}, and there is no IceStorm to carry it",
    "Topics need IceStorm: the deployment's own, under `services:`, or one outside that the component's configuration "
    "names as its topic manager.",
    _with(deployed("components:\n" + _SPEAKS), speech=_PUBLISHES, News=_NEWS),
    _with(deployed(_STORM + "components:\n" + _SPEAKS), speech=_PUBLISHES, News=_NEWS),
    _CHECK,
)
TWO_STORMS = Code(
    "RC4209",
    "error",
    "'{source}' has topics, and there are several IceStorms that could carry them: {storms}",
    "What is published with one IceStorm does not reach those subscribed with another one. An include may have its "
    "own.",
    _with(
        deployed("services: {a: {icestorm: {}}, b: {icestorm: {port: 9998}}}\ncomponents:\n" + _SPEAKS),
        speech=_PUBLISHES, News=_NEWS,
    ),
    _with(deployed("services: {a: {icestorm: {}}}\ncomponents:\n" + _SPEAKS), speech=_PUBLISHES, News=_NEWS),
    _CHECK,
)
NOBODY_PUBLISHES = Code(
    "RC4210",
    "warning",
    "'{source}' is subscribed to {topic}, which nobody in this deployment publishes",
    "It will hear nothing, unless something outside publishes the topic with the same IceStorm. Often the names "
    "differ: `topics:` renames, a configuration may have a prefix, and what an include both publishes and subscribes "
    "to is called after it, as in left/State.",
    _with(deployed(_STORM + _BOTH), speech=_TALKS, mouth=_SUBSCRIBES, News=_NEWS),
    _with(deployed(_STORM + _BOTH), speech=_PUBLISHES, mouth=_SUBSCRIBES, News=_NEWS),
    _CHECK,
)
TOPIC_MISMATCH = Code(
    "RC4211",
    "error",
    "'{source}' and '{target}' do not mean the same by the topic {topic}: {difference}",
    "All that publish a topic or are subscribed to it must agree on its interface, as both ends of a connection do.",
    _with(
        deployed(_STORM + _BOTH), speech=_PUBLISHES, mouth=_SUBSCRIBES.replace("News]\ni", "News2]\ni"), News=_NEWS,
        News2=_NEWS.replace("what: string", "what: int"),
    ),
    _with(
        deployed(_STORM + _BOTH), speech=_PUBLISHES, mouth=_SUBSCRIBES.replace("News]\ni", "News2]\ni"), News=_NEWS,
        News2=_NEWS,
    ),
    _CHECK,
)
_OF_ENDPOINTS = (
    "there is no protocol '{protocol}'",
    "'{option}' is no option of {protocol}; {protocol} takes {options}",
    "'{option}' needs a value",
    "'{option}' takes no value, and has '{value}'",
    "an endpoint is missing behind the colon",
    "a quote is not closed",
)
BAD_ENDPOINT = Code(
    "RC4301",
    "error",
    "{name} cannot be served at '{text}': {problem}",
    "Endpoints are spelled as Ice spells them: a protocol (tcp, udp, ssl, ws or wss) with its options, which are "
    "checked as Ice would check them, and here a fixed port, which the others are told. A program that is none of Ice "
    "gets texts of any kind by `args:` and `env:`.",
    deployed(_BOTH + "  laser: {program: sh, endpoints: {Laser: tcp}}\n"),
    deployed(_BOTH + "  laser: {program: sh, endpoints: {Laser: tcp -p 10003}}\n"),
    _CHECK,
    says=tuple(
        f"{{name}} cannot be served at '{{text}}': {reason}"
        for reason in (*_OF_ENDPOINTS, "it holds no endpoint", "it has no fixed port")
    ),
)
BAD_PROXY = Code(
    "RC4015",
    "error",
    "'{text}' is no proxy: {problem}",
    "What is outside of the deployment is named by its proxy, as Ice spells it: an identity, options such as `-o`, and "
    "endpoints (`mouth:tcp -h 10.0.0.9 -p 10002`) or an adapter (`mouth @ Head`). What Ice would refuse when the "
    "component starts is refused here; protocols of its plug-ins (ssl, wss, bt) count as known. A program that is none "
    "of Ice gets texts of any kind by `args:` and `env:`.",
    deployed("components:\n" + _SPEAKS.replace("h}", 'h, connect: {Mouth: "mouth:tcp -h 10.0.0.9 -q 10002"}}')),
    deployed("components:\n" + _SPEAKS.replace("h}", 'h, connect: {Mouth: "mouth:tcp -h 10.0.0.9 -p 10002"}}')),
    _CHECK,
    says=tuple(
        f"'{{text}}' is no proxy: {reason}"
        for reason in (
            "it is empty", "the identity is missing", "an identity is CATEGORY/NAME, with one slash",
            "a proxy has no option '{option}'; it takes {options}",
            "'{option}' stands where an option, a colon or @ is expected", "the adapter is missing behind the @",
            "nothing can follow the adapter", *_OF_ENDPOINTS,
        )
    ),
)
PASSED_OVER = Code(
    "RC4016",
    "warning",
    "Ice passes over this endpoint: {problem}",
    "Of a proxy's endpoints Ice uses those whose protocol it knows; the others it mentions in a log when the component "
    "starts.",
    deployed("components:\n" + _SPEAKS.replace(
        "h}", 'h, connect: {Mouth: "mouth:tcp -h 10.0.0.9 -p 10002:tpc -h 10.0.0.8 -p 10002"}}'
    )),
    deployed("components:\n" + _SPEAKS.replace(
        "h}", 'h, connect: {Mouth: "mouth:tcp -h 10.0.0.9 -p 10002:tcp -h 10.0.0.8 -p 10002"}}'
    )),
    _CHECK,
    says=("Ice passes over this endpoint: there is no protocol '{protocol}'",),
)
NOT_IN_THIS_FORM = Code(
    "RC4018",
    "warning",
    "'{name}' cannot be exported to {form} as it is: {reason}",
    "Not every tool can be told everything: a control character in an argument has no spelling in XML, and a key under "
    "`x-rcmanager:` becomes the name of an element. Another sign stands there instead. What could become more than a "
    "text, such as a line of its own in a unit, is an error, and nothing is exported. `rcyaml deploy up` runs it as it "
    "is.",
    deployed('components:\n' + _MOVES + '  laser: {program: sleep, args: ["1", "\\e[0m"]}\n'),
    deployed("components:\n" + _MOVES + "  laser: {program: sleep, args: ['1']}\n"),
    "deploy export head.ddsl.yaml --as icegrid -o out",
)
NAME_TOO_LONG = Code(
    "RC4109",
    "error",
    "the {what} '{name}' has too long a name: its file '{file}' would have a name of {size} bytes, and {limit} are the "
    "most",
    "Logs, configurations and units are called after what they belong to, and systems take names of files up to 255 "
    "bytes. The longest is that of a unit for systemd, DEPLOYMENT-ENTRY.service; an entry of an include has the names "
    "of all includes before its own.",
    deployed(_BOTH + f"  {'l' * 250}: {{program: sleep, args: [1]}}\n"),
    deployed(_BOTH + f"  {'l' * 200}: {{program: sleep, args: [1]}}\n"),
    _CHECK,
)
PATH_TOO_LONG = Code(
    "RC4110",
    "error",
    "no file can have the path '{path}': {problem}",
    "Systems take names of files up to 255 bytes, and paths up to 4095; letters other than those of English have two "
    "bytes or more.",
    deployed(_BOTH + f"  laser: {{program: sleep, args: [1], cwd: {'c' * 300}}}\n"),
    deployed(_BOTH + "  laser: {program: sleep, args: [1], cwd: mouth}\n"),
    _CHECK,
    says=(
        "no file can have the path '{path}': it has {size} bytes, and {limit} are the most",
        "no file can have the path '{path}': a name in it has {size} bytes, and {limit} are the most",
    ),
)
PORT_TOO_HIGH = Code(
    "RC4302",
    "error",
    "'{name}' would have port {port}, and 65535 is the last",
    "The ports of an entry with instances are counted up, each by the number of ports that the entry gives.",
    deployed("components:\n  mouth{i}: {component: mouth, instances: 3, port: 65534}\n"),
    deployed("components:\n  mouth{i}: {component: mouth, instances: 2, port: 65534}\n"),
    _CHECK,
)
PORT_CONFLICT = Code(
    "RC4303",
    "error",
    "{name} and {other} have the same port, {port}, on {host}",
    "Of two processes on one host, only one can listen on a port.",
    deployed("components:\n" + _SPEAKS.replace("h}", "h, port: 10001}") + _MOVES.replace("h}", "h, port: 10001}")),
    deployed("components:\n" + _SPEAKS.replace("h}", "h, port: 10001}") + _MOVES.replace("h}", "h, port: 10002}")),
    _CHECK,
)
LOOPBACK = Code(
    "RC4304",
    "error",
    "host '{name}' has the address {address}, by which the other hosts reach only themselves",
    "With several hosts, an address is one by which all of them reach the host: localhost and 127.… mean each "
    "machine itself.",
    deployed("hosts: {a: localhost, b: 10.0.0.3}\ncomponents:\n" + _SPEAKS.replace("h}", "h, host: a}")
             + _MOVES.replace("h}", "h, host: b}")),
    deployed("hosts: {a: 10.0.0.2, b: 10.0.0.3}\ncomponents:\n" + _SPEAKS.replace("h}", "h, host: a}")
             + _MOVES.replace("h}", "h, host: b}")),
    _CHECK,
)
BAD_ADDRESS = Code(
    "RC4305",
    "error",
    "'{address}' is no address: {problem}",
    "A host's address is an IPv4 or IPv6 address, or a name that is resolved when the deployment is started "
    "(`rcyaml check --environment` resolves it, too).",
    deployed("hosts: {a: 10.0.0.256}\n" + _BOTH),
    deployed("hosts: {a: 10.0.0.2}\n" + _BOTH),
    _CHECK,
    says=(
        "'{address}' is no address: it is no name of a machine",
        "'{address}' is no address: it is no {kind} address",
        "'{address}' is no address: it stands for every address of a machine",
        "'{address}' is no address: it stands for many machines",
    ),
)
NOT_RESOLVED = Code(
    "RC4306",
    "warning",
    "the address of host '{name}', {address}, cannot be resolved here",
    "A name must lead to the same machine wherever it is looked up: from the machine that deploys and from every host. "
    "Only `--environment` looks.",
    deployed("hosts: {a: nowhere.invalid}\n" + _BOTH),
    deployed("hosts: {a: 10.0.0.2}\n" + _BOTH),
    f"{_CHECK} --environment",
)
NO_ENTRY = Code(
    "RC4307",
    "error",
    "'{path}' leads nowhere: {problem}",
    "A path under `set:` may change one entry of a list that the component's values document, or the default, gives. "
    "Where there is none, or to add one, give the whole list.",
    deployed("components:\n" + _SPEAKS + _MOVES.replace("h}", 'h, set: {"angles[2]": 1.5}}')) | {
        "mouth/mouth.pdsl.yaml": "component: mouth.cdsl.yaml\nparameters:\n"
        "  angles: {list: float, default: [0.5, 1]}\n"
    },
    deployed("components:\n" + _SPEAKS + _MOVES.replace("h}", 'h, set: {"angles[1]": 1.5}}')) | {
        "mouth/mouth.pdsl.yaml": "component: mouth.cdsl.yaml\nparameters:\n"
        "  angles: {list: float, default: [0.5, 1]}\n"
    },
    _CHECK,
    says=(
        "'{path}' leads nowhere: {why}",
    ),
)
_REQUIRES = _MOUTH + "requires: [{Speech: {interface: Speech, absent: ABSENT}}]\n"
CYCLE = Code(
    "RC4401",
    "warning",
    "these need each other: {circle}; '{first}' starts before '{second}', and {does}",
    "Processes start after what they require. In a circle one of them starts first all the same: one whose document "
    "says `absent: ignore` of the proxy, else one that waits for it (`absent: wait`, the default).",
    _with(_RIGHT, mouth=_REQUIRES.replace("ABSENT", "wait")),
    _RIGHT,
    _CHECK,
)
DEADLOCK = Code(
    "RC4402",
    "error",
    "these need each other, and none of them can start first: {circle}",
    "Processes start after what they require and what `after:` names. In a circle someone has to start without the "
    "other: a component that waits for its proxy (`absent: wait`) or does without it (`absent: ignore`).",
    deployed("components:\n" + _SPEAKS.replace("h}", "h, after: [mouth]}")
             + _MOVES.replace("h}", "h, after: [speech]}")),
    deployed("components:\n" + _SPEAKS.replace("h}", "h, after: [mouth]}") + _MOVES),
    _CHECK,
)
NOT_BUILT = Code(
    "RC4403",
    "warning",
    "'{name}' has no executable: there is no {path}",
    "A component is compiled, and one in C++ built, before it can be started. For `check` this is a warning, since a "
    "fresh checkout has no builds; `deploy` cannot do without. Only what runs on this machine is looked at.",
    {path: text for path, text in _RIGHT.items() if path != "speech/bin/SpeechComp"},
    _RIGHT,
    _CHECK,
)
NO_PROGRAM = Code(
    "RC4404",
    "warning",
    "'{name}' cannot be started: {problem}",
    "A program is found by PATH, or at a path from the folder where it runs, and must be executable. Only what runs on "
    "this machine is looked at.",
    deployed(_BOTH + "  viewer: {program: ./viewer}\n"),
    deployed(_BOTH + "  viewer: {program: ./viewer}\n") | {"viewer": "-> /bin/true"},
    _CHECK,
    says=(
        "'{name}' cannot be started: there is no {path}",
        "'{name}' cannot be started: {path} is a folder",
        "'{name}' cannot be started: {path} is not executable",
        "'{name}' cannot be started: PATH finds no '{program}'",
        "'{name}' cannot be started: there is no folder {folder} to run in",
    ),
)
OPEN_CONFIG = Code(
    "RC4311",
    "warning",
    "{file} holds a secret in line {line}, and others can read it",
    "A configuration that is no values document goes to its process as it is. A property is secret whose name says so, "
    "or that a component's parameter with `secret: true` has; in a URL the password is. Let nobody but the owner read "
    "the file: what is derived from it nobody else can read, either.",
    {**deployed(f"components:\n{_MOVES}" + _SPEAKS.replace("h}", "h, config: speech.conf}")),
     "speech.conf": "api_token=hunter2\n"},
    {**deployed(f"components:\n{_MOVES}" + _SPEAKS.replace("h}", "h, config: speech.conf}")),
     "speech.conf": "api_token=${env:API_TOKEN}\n"},
    _CHECK,
)
OPEN_SECRET = Code(
    "RC4310",
    "warning",
    "this is secret, and others can read {file}",
    "A password or a token that stands in a document is read by whoever can read the document, and often goes into a "
    "repository with it. Under `env:` and `set:`, `{env: NAME}` takes it from the environment, and `{file: PATH}` from "
    "a file. Arguments are seen by everybody on the machine while the process "
    "runs. Secret is what its name says to be so (`DB_PASSWORD`, `--api-key=…`), the password in a URL, and what is "
    "given to a parameter with `secret: true`.",
    deployed(f"components:\n{_MOVES}" + _SPEAKS.replace("h}", "h, env: {API_TOKEN: hunter2}}")),
    deployed(f"components:\n{_MOVES}" + _SPEAKS.replace("h}", "h, env: {API_TOKEN: {env: API_TOKEN}}}")),
    _CHECK,
)
