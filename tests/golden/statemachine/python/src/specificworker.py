"""Door"""

# This file is yours: rcyaml wrote it once, and will not touch it again. Its worker has
#   self.parameters: the values of etc/config, as generated/parameters.py describes them
#   self.events, which fires events of the state machine from any thread: self.events.open()
#   self.statemachine.states, the names of all active states, and self.statemachine.is_in(NAME)
#   self.statemachine.event, the one that is being handled, with its name and data
#   self.log, self.mutex, self.getPeriod(), self.setPeriod(ms), self.killYourSelf()

from __future__ import annotations

from generated.genericworker import GenericWorker


class SpecificWorker(GenericWorker):
    """What Door does."""

    def initialize(self) -> None:
        """Called once: all proxies exist, and calls from other components wait until it returns."""
        self.log.info("initializing")

    def compute(self) -> None:
        """Called every period (100 ms, unless etc/config sets another one)."""

    # The state machine calls these when a state is entered. sm_STATE_exit(), called when the state is left, and
    # sm_STATE_period(), called every period while it is active, may be added.

    def sm_closed(self) -> None:
        """The state 'closed' has been entered.

        Nobody passes.
        """
        self.log.info("sm_closed() is still to be written")

    def sm_opened(self) -> None:
        """The state 'opened' has been entered."""
        self.log.info("sm_opened() is still to be written")

    def sm_still(self) -> None:
        """The state 'still' has been entered."""
        self.log.info("sm_still() is still to be written")

    def sm_moving(self) -> None:
        """The state 'moving' has been entered."""
        self.log.info("sm_moving() is still to be written")

    def sm_gone(self) -> None:
        """The state 'gone' has been entered."""
        self.log.info("sm_gone() is still to be written")

    def pushed(self) -> bool:
        """Whether the state machine's condition 'pushed' holds."""
        self.log.info("pushed() is still to be written")
        return False

    def ring(self) -> None:
        """The state machine's action 'ring'."""
        self.log.info("ring() is still to be written")
