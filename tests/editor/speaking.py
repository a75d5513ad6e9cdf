"""A component that speaks: the workspace in which the language server is tried beside its documents."""

from __future__ import annotations

from lsprotocol import types

ROBOT = "\U0001f916"
"""One character of two units, as the protocol counts them."""

SPEECH = "module: RoboCompSpeech\ninterfaces:\n  Speech: {methods: {say: {in: {text: string}}}}\n"
COMPONENT = "component: SpeechComp\nlanguage: python\nimports: [Speech]\nimplements: [Speech]\n"
PARAMETERS = "component: speech.cdsl.yaml\nparameters: {volume: {type: int, default: 3, range: [0, 9]}}\n"
DOCUMENTS = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Speech.idsl.yaml": SPEECH,
    "speech/speech.cdsl.yaml": COMPONENT,
}


def worker(signature: str, body: str) -> dict[str, str]:
    """The user's code, with one method."""
    head = "from generated.genericworker import GenericWorker\n\n\nclass SpecificWorker(GenericWorker):\n"
    return {"speech/src/specificworker.py": f"{head}    def {signature}\n        {body}\n"}


def at(line: int, start: int, end: int) -> types.Range:
    return types.Range(types.Position(line, start), types.Position(line, end))
