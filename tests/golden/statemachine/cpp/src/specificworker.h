// This file is yours: rcyaml wrote it once, and will not touch it again.
#pragma once

#include "genericworker.h"

/// Door
///
/// Besides the methods below, it has:
/// - parameters: the values of etc/config, as generated/parameters.h declares them
/// - events, which fires events of the state machine from any thread: events.open()
/// - statemachine.states(), the names of all active states, and statemachine.isIn(NAME)
/// - statemachine.event(), the event that is being handled, with its name and data
/// - log, mutex, communicator, getPeriod(), setPeriod(ms), killYourSelf()
class SpecificWorker : public GenericWorker
{
public:
    /// Called once: all proxies exist, and calls from other components wait until it returns.
    void initialize();

    /// Called every period (100 ms, unless etc/config sets another one).
    void compute();

    // The state machine calls these when a state is entered. sm_STATE_exit(), called when the state is left, and
    // sm_STATE_period(), called every period while it is active, may be added.
    void sm_closed();
    void sm_opened();
    void sm_still();
    void sm_moving();
    void sm_gone();
    bool pushed();
    void ring();
};
