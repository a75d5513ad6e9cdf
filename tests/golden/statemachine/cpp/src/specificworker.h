// This file is yours: rcyaml wrote it once, and will not touch it again.
#pragma once

#include "genericworker.h"

/// Door
///
/// Beside the methods below it has:
/// - parameters: what etc/config and generated/parameters.h say
/// - events, which fires the state machine's events, from any thread: events.open()
/// - statemachine.states(), the names of all active states, and statemachine.isIn(NAME)
/// - statemachine.event(), the one that is being handled, with its name and data
/// - log, mutex, communicator, getPeriod(), setPeriod(ms), killYourSelf()
class SpecificWorker : public GenericWorker
{
public:
    /// Called once: all proxies are there, and calls from other components wait until this is done.
    void initialize();

    /// Called every period (100 ms, unless etc/config says otherwise).
    void compute();

    // The state machine: called when a state is entered. There may also be sm_STATE_exit(), called when it is left, and
    // sm_STATE_period(), called every period in it.
    void sm_closed();
    void sm_opened();
    void sm_still();
    void sm_moving();
    void sm_gone();
    bool pushed();
    void ring();
};
