"""A robot whose documents have a text in every place where one may stand. Texts that say `Free` may be any."""

from __future__ import annotations

TREE: dict[str, str] = {
    "rcyaml.yaml": "doc: Free workspace\ninterfaces: [.]\nx-own: Free own\n",
    "Speech.idsl.yaml": """
module: RoboCompSpeech
doc: Free module
constants:
  voice: {type: string, value: Free voice, doc: Free constant}
  most: {type: int, value: 100, unit: percent}
types:
  Language: {enum: {spanish: {doc: Free enumerator}, english: }, doc: Free enum}
  Utterance:
    doc: Free struct
    struct:
      text: {type: string, default: Free default, doc: Free member}
      speed: {type: float, default: 1.0, unit: words/s}
      language: {type: Language, default: english}
  Utterances: {sequence: Utterance, doc: Free sequence}
  Lexicon: {map: {key: string, value: Utterance}, doc: Free map}
exceptions:
  Failed: {doc: Free exception, struct: {what: string}}
interfaces:
  Speech:
    doc: Free interface
    methods:
      say: {doc: Free method, in: {words: {type: string, doc: Free parameter}, count: int}, returns: {type: bool, doc: Free result}, throws: [Failed]}
      status: {out: {volume: {type: int, unit: percent}}, doc: "Free method\\nof two lines"}
topics:
  Heard: {doc: Free topic, methods: {spoken: {in: {utterance: Utterance}, doc: Free message}}}
x-tools: [Free own]
""",
    "speech/speech.cdsl.yaml": """
component: SpeechComp
doc: Free component
language: python
imports: [Speech]
implements: [Speech, {Control: {interface: Speech, doc: Free port}}]
requires: [{Other: {interface: Speech, doc: Free proxy, absent: ignore, timeout: 10 s}}]
publishes: [Heard]
subscribes: [{Ears: {interface: Heard, doc: Free subscription}}]
parameters: speech.pdsl.yaml
period: 100 ms
statemachine:
  doc: Free machine
  initial: initialize
  final: finalize
  states: {compute: {doc: Free state, initial: sense, states: {sense: {}, act: }, transitions: {sense: act}}}
  transitions: {initialize: compute, compute: [compute, {to: finalize, event: stop, if: low, do: park, doc: Free transition}]}
uses:
  libraries: [{pip: numpy, version: ">=1", doc: Free library}]
x-own: Free own
""",
    "speech/speech.pdsl.yaml": """
component: speech.cdsl.yaml
doc: Free parameters
types:
  Speed: {doc: Free type, enum: {slow: {doc: Free enumerator}, fast: }}
  Motor:
    doc: Free struct
    struct:
      name: {type: string, doc: Free member, default: Free default}
      id: {type: string, pattern: "[A-Z][0-9]*", doc: Free id, default: A1}
      vel: {type: float, range: {above: 0, to: 2}, default: 0.9, unit: rad/s}
parameters:
  voice: {type: string, doc: Free parameter, default: Free text default}
  tone: {type: string, values: [Free value, low], default: low}
  words: {list: string, default: [Free word]}
  names: {map: string, default: {left: Free entry}}
  speed: {type: Speed, default: slow}
  volume: {type: int, range: [0, 100], unit: Free unit, default: 50, editable: true}
  motors: {list: Motor, size: [0, 16], default: []}
  group: {group: {inner: {type: string, default: Free inner}}, doc: Free group}
constraints:
  - {that: volume < 90, else: Free reason, doc: Free constraint}
""",
    "speech/etc/config.yaml": """
component: ../speech.cdsl.yaml
doc: Free values
parameters:
  voice: Free given
  words: [Free one, two]
  names: {right: Free right}
  motors: [{name: Free motor, id: B2}]
endpoints: {Speech: tcp -p 10001}
proxies: {Other: "mouth:tcp -p 10002"}
topics: {prefix: {Heard: Free prefix}}
ice: {Program: Free program}
properties: {own.thing: Free property}
""",
    "arm/arm.cdsl.yaml": """
component: ArmComp
doc: Free component
language: {name: cpp, standard: 20}
imports: [Speech]
requires: [{Voice: {interface: Speech, doc: Free proxy}}]
parameters: arm.pdsl.yaml
statemachine: {initial: go, states: {go: {doc: Free state}}, doc: Free machine}
uses:
  sources: [Classes/draw/draw.cpp]
  libraries: [{cmake: OpenCV, version: ">=4", doc: Free library}, {link: m}]
""",
    "arm/Classes/draw/draw.cpp": "int draw;\n",
    "arm/arm.pdsl.yaml": """
component: arm.cdsl.yaml
doc: Free parameters
types:
  Joint: {struct: {name: {type: string, default: Free joint, doc: Free member}}}
parameters:
  label: {type: string, doc: Free parameter, default: Free label}
  kind: {type: string, values: [Free kind, plain], default: plain}
  joints: {list: Joint, default: [{name: Free first}]}
  limit: {type: float, range: [0, 1], unit: Free unit, default: 0.5}
constraints:
  - {that: limit > 0.1, else: Free reason}
""",
    "robot.ddsl.yaml": """
deployment: Robot
doc: Free deployment
components:
  speech:
    component: speech/speech.cdsl.yaml
    doc: Free entry
    args: [--word, Free argument]
    env: {WORD: Free variable, TOKEN: {env: ROBOT_TOKEN}}
    port: 10011
    connect: {Other: "other:tcp -p 10012"}
    set: {voice: Free setting, "names[\\"left\\"]": Free entry of a map}
    ready: {log: "ready", within: 10 s}
    x-own: Free own
  arm: {component: arm/arm.cdsl.yaml, connect: {Voice: speech.Speech}, doc: Free entry}
  sim:
    program: /bin/true
    args: [Free simulation, "2"]
    env: {DISPLAY: Free display}
    cwd: /tmp
    doc: Free program
    ready: {command: [test, Free command]}
  watch: {program: /usr/bin/watch, ready: {command: "test Free"}, restart: {policy: on-failure, delay: 1 s, tries: 5}}
services: {storm: {icestorm: {port: 9999}, doc: Free service}}
groups:
  body: {components: [speech, arm], doc: Free group, expose: {Speech: {member: speech, rate: 10, allow: [say], doc: Free exposure}}}
""",
}
