"""RC2238–RC2241: what of a state machine stands behind something that is always taken first, or stands there twice."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes.machines import INLINE, inline

DEAD_TRANSITION = Code(
    "RC2238",
    "error",
    "this transition of {state} is never taken{when}: {why}",
    "Of the transitions of a state, the first one that fits is taken. One that stands behind another one for the same "
    "event, or behind one for `*` or `door.*` that matches it too, waits in vain, unless the first has a condition, "
    "and not the same one; so does every one beside a transition that waits for nothing. Those of a state inside come "
    "before. In an SCXML file it is a warning, unless both are for the same event and do different things.",
    inline("  initial: closed\n  states: {opened: {}, broken: {}}\n"
           "  transitions: {closed: [{to: opened, event: open}, {to: broken, event: open}]}\n"),
    inline("  initial: closed\n  states: {opened: {}, broken: {}}\n"
           "  transitions: {closed: [{to: opened, event: open, if: whole}, {to: broken, event: open}]}\n"),
    says=("this transition of {state} is never taken for '{event}': one before it takes '{other}'",
          "this transition of {state} is never taken for '{event}': one before it takes '{other}' on the same "
          "condition",
          "this transition of {state} is never taken for '{event}': one behind it is taken at once",
          "this transition of {state} is never taken: one before it is taken at once"),
)
EVENT_TWICE = Code(
    "RC2239",
    "error",
    "the event '{event}' is listed twice",
    "`events:` lists each event that code fires once; the second one is probably another one, misspelled.",
    inline("  initial: closed\n  events: [open, open]\n  states: {opened: {}}\n"
           "  transitions: {closed: {to: opened, event: open}}\n"),
    inline("  initial: closed\n  events: [open, close]\n  states: {opened: {}}\n"
           "  transitions: {closed: {to: opened, event: open}, opened: {to: closed, event: close}}\n"),
)
HISTORY_TWICE = Code(
    "RC2240",
    "error",
    "a second transition of the history '{id}'",
    "A history has one transition: it says where to go as long as there is nothing to remember.",
    inline("  initial: closed\n  states:\n    closed:\n      initial: locked\n"
           "      states: {locked: {}, ajar: {}, last: {history: shallow}}\n"
           "      transitions: {locked: {to: ajar, event: pull}, last: [locked, ajar]}\n"),
    INLINE,
)
HISTORY_WAITS = Code(
    "RC2241",
    "error",
    "the transition of the history '{id}' waits for nothing: it has neither event nor condition",
    "Who goes to a history comes at once to where its surroundings were left, or to where its transition leads.",
    inline("  initial: closed\n  states:\n    closed:\n      initial: locked\n"
           "      states: {locked: {}, last: {history: shallow}}\n"
           "      transitions: {locked: {to: last, event: pull}, last: {to: locked, event: back}}\n"),
    INLINE,
)
