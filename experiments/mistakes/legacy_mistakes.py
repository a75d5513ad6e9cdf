"""Mistakes in legacy files, as edits of `legacy/`: a component of RoboComp, interfaces, configuration and launcher."""

from __future__ import annotations

from dataclasses import dataclass

CREATING = "Creating components"
PROXIES = "Adding and removing proxies"
INTERFACES = "Changing interfaces"
PARAMETERS = "Configuration"
DEPLOYING = "Deployment"
IN_CPP = "The same in C++"
TASKS = (CREATING, PROXIES, INTERFACES, PARAMETERS, DEPLOYING, IN_CPP)
PYTHON, CPP = "python", "cpp"

CDSL, SPEECH = "components/speech/speech.cdsl", "interfaces/Speech.idsl"
CONFIG, WORKER = "components/speech/etc/config", "components/speech/src/specificworker.py"
HEADER, WORKER_CPP = "components/speech/src/specificworker.h", "components/speech/src/specificworker.cpp"
LAUNCHER = "sub.toml"


@dataclass(frozen=True)
class Mistake:
    """`edits` are a path with an old and a new text."""

    task: str
    what: str
    edits: tuple[tuple[str, str, str], ...]

    @property
    def language(self) -> str:
        return CPP if self.task == IN_CPP else PYTHON


def one(task: str, what: str, path: str, old: str, new: str) -> Mistake:
    return Mistake(task, what, ((path, old, new),))


SECOND = """
[[components]]
name = "speech2"
cwd = "components/speech"
cmd = "src/speech.py etc/config"
ice_name = "Speech:tcp -h localhost -p 10101"
"""

MISTAKES = [
    one(CREATING, "a misspelled keyword", CDSL, "implements", "implement"),
    one(CREATING, "an unknown language", CDSL, "Python", "Pyton"),
    one(CREATING, "an import of a file that does not exist", CDSL, "Mouth.idsl", "Mouht.idsl"),
    one(CREATING, "a missing semicolon", CDSL, "requires Mouth;", "requires Mouth"),
    one(CREATING, "text after the end", CDSL, "language Python;\n};", "language Python;\n};\nlanguage Cpp;"),
    one(CREATING, "a syntax error in the user's code", WORKER, "def Speech_say(self, text):", "def Speech_say(self, text)"),
    one(CREATING, "a method of the worker with a typing error", WORKER, "def Speech_say", "def Speech_sya"),
    #
    one(PROXIES, "a requirement in other letters", CDSL, "requires Mouth", "requires mouth"),
    one(PROXIES, "the name of the component instead of the interface", CDSL, "requires Mouth", "requires MouthComp"),
    one(PROXIES, "an interface whose file is not imported", CDSL, 'import "Mouth.idsl";\n', ""),
    one(PROXIES, "the same interface twice", CDSL, "requires Mouth", "requires Mouth, Mouth"),
    one(PROXIES, "code that still uses a removed proxy", CDSL, "\t\trequires Mouth;\n", ""),
    one(PROXIES, "a proxy under the name of its interface", WORKER, "self.mouth_proxy", "self.Mouth_proxy"),
    one(PROXIES, "a method that the interface lacks", WORKER, "mouth_proxy.open(", "mouth_proxy.opne("),
    #
    one(INTERFACES, "a type that does not exist", SPEECH, "string text", "strng text"),
    one(INTERFACES, "a misspelled keyword", SPEECH, "interface Speech", "interfacee Speech"),
    one(INTERFACES, "a missing semicolon", SPEECH, "say(string text);", "say(string text)"),
    one(INTERFACES, "two methods of one name", SPEECH, "say(string text);", "say(string text);\n\t\tint say(int number);"),
    one(INTERFACES, "a reserved word of Slice as a name", SPEECH, "string text", "string class"),
    one(INTERFACES, "two names that differ only in case", SPEECH, "say(string text);", "say(string text, int Text);"),
    one(INTERFACES, "a method that is added, and not implemented", SPEECH, "say(string text);", "say(string text);\n\t\tvoid stop();"),
    one(INTERFACES, "a method that is renamed, and implemented under its old name", SPEECH, "int say(", "int speak("),
    one(INTERFACES, "a new parameter: the method is stale", SPEECH, "string text", "string text, int volume"),
    #
    one(PARAMETERS, "a misspelled property of a proxy", CONFIG, "MouthProxy", "MouthProxi"),
    one(PARAMETERS, "a proxy that cannot be parsed", CONFIG, "mouth:tcp", "mouth;tcp"),
    one(PARAMETERS, "a port out of range", CONFIG, "Speech.Endpoints=tcp -p 10101", "Speech.Endpoints=tcp -p 1010100"),
    one(PARAMETERS, "a property that is set twice", CONFIG, "Speech.Endpoints=tcp -p 10101", "Speech.Endpoints=tcp -p 10101\nSpeech.Endpoints=tcp -p 10109"),
    one(PARAMETERS, "a text instead of the number that code expects", CONFIG, "Volume=50", "Volume=loud"),
    #
    one(DEPLOYING, "a folder that does not exist", LAUNCHER, "components/speech", "components/spech"),
    one(DEPLOYING, "a program that does not exist", LAUNCHER, "src/speech.py", "src/speach.py"),
    one(DEPLOYING, "a misspelled key", LAUNCHER, "cmd =", "cmdd ="),
    one(DEPLOYING, "two processes at one port", LAUNCHER, '10101"\n', '10101"\n' + SECOND),
    one(DEPLOYING, "the launcher and the configuration name different ports", LAUNCHER, "-p 10101", "-p 10177"),
    one(DEPLOYING, "an entry that is not closed", LAUNCHER, '"speech"\n', '"speech\n'),
    #
    one(IN_CPP, "an unknown language", CDSL, "Cpp", "Cppp"),
    one(IN_CPP, "a syntax error in the user's code", WORKER_CPP, "return true;", "return true"),
    one(IN_CPP, "a method of the worker with a typing error", WORKER_CPP, "::Speech_say", "::Speech_sya"),
    one(IN_CPP, "code that still uses a removed proxy", CDSL, "\t\trequires Mouth;\n", ""),
    one(IN_CPP, "a proxy under the name of its interface", WORKER_CPP, "mouth_proxy", "Mouth_proxy"),
    one(IN_CPP, "a method that the interface lacks", WORKER_CPP, "->open(", "->opne("),
    one(IN_CPP, "an argument of another type", WORKER_CPP, "open(text.size())", "open(text)"),
    one(IN_CPP, "a method that is added, and not implemented", SPEECH, "say(string text);", "say(string text);\n\t\tvoid stop();"),
    one(IN_CPP, "a method that is renamed, and implemented under its old name", SPEECH, "int say(", "int speak("),
    one(IN_CPP, "a new parameter: the method is stale", SPEECH, "string text", "string text, int volume"),
]  # fmt: skip
