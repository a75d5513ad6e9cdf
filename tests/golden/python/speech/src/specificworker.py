"""SpeechComp: Synthesizes speech."""

# This file is yours: rcyaml wrote it once, and will not touch it again. Its worker has
#   self.twin_proxy: calls Twin
#   self.backup_proxy: calls Backup
#   self.speechevents_proxy: publishes SpeechEvents
#   self.parameters: the values of etc/config, as generated/parameters.py describes them
#   self.log, self.mutex, self.getPeriod(), self.setPeriod(ms), self.killYourSelf()

from __future__ import annotations

from generated.genericworker import GenericWorker
from generated.interfaces import RoboCompSpeech, RoboCompTypes


class SpecificWorker(GenericWorker):
    """What SpeechComp does."""

    def initialize(self) -> None:
        """Called once: all proxies exist, and calls from other components wait until it returns."""
        self.log.info("initializing")

    def compute(self) -> None:
        """Called every period (50 ms, unless etc/config sets another one)."""

    # Speech: other components call these.

    def Speech_say(self, text: str, volume: float) -> bool:
        """Says a text."""
        self.log.info("Speech_say() is still to be written")
        return False

    def Speech_status(self) -> tuple[RoboCompSpeech.Language, int, dict[str, list[RoboCompSpeech.Utterance]]]:
        """Speech.status"""
        self.log.info("Speech_status() is still to be written")
        return RoboCompSpeech.Language.spanish, 0, {}

    def Speech_record(self, seconds: int) -> bytes:
        """Speech.record"""
        self.log.info("Speech_record() is still to be written")
        return b""

    def Speech_stop(self) -> None:
        """Speech.stop"""
        self.log.info("Speech_stop() is still to be written")

    def Speech_whereIsTheMouthThatSaysAllThis(
        self,
        utterances: list[RoboCompSpeech.Utterance],
        relativeTo: RoboCompTypes.Pose,
        allOfTheRest: dict[str, list[RoboCompSpeech.Utterance]],
    ) -> tuple[RoboCompTypes.Pose, bool]:
        """Speech.whereIsTheMouthThatSaysAllThis"""
        self.log.info("Speech_whereIsTheMouthThatSaysAllThis() is still to be written")
        return RoboCompTypes.Pose(), False

    # SpeechEvents: events that others publish.

    def SpeechEvents_spoken(self, utterance: RoboCompSpeech.Utterance, at: RoboCompTypes.Pose) -> None:
        """Something was said."""
        self.log.info("SpeechEvents_spoken() is still to be written")
