"""The servant of Speech: it hands calls to the worker."""

import RoboCompSpeech


class SpeechI(RoboCompSpeech.Speech):
    def __init__(self, worker):
        self.worker = worker

    def say(self, text, current=None):
        return self.worker.Speech_say(text)
