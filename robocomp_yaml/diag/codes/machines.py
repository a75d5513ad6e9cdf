"""RC22xx: state machines, as SCXML or in the CDSL."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code, Files

_COMPONENT = "component: DoorComp\nlanguage: python\n"
_OPEN = '<state id="closed"><transition event="open" target="opened"/></state>\n<state id="opened"/>\n'


def _file(inner: str, attributes: str = ' initial="closed"', head: str = "") -> Files:
    """A component whose machine is a file."""
    text = f'{head}<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0"{attributes}>\n{inner}</scxml>\n'
    return {"door.cdsl.yaml": f"{_COMPONENT}statemachine: door.scxml\n", "door.scxml": text}


def inline(text: str) -> Files:
    return {"door.cdsl.yaml": f"{_COMPONENT}statemachine:\n{text}"}


_RIGHT = _file(_OPEN)
INLINE = inline("  initial: closed\n  states: {opened: {}}\n  transitions: {closed: {to: opened, event: open}}\n")

UNREADABLE = Code(
    "RC2201",
    "error",
    "the state machine's file '{path}' cannot be read: {reason}",
    "`statemachine:` names an SCXML file by a path relative to the component's document. It is not looked for "
    "anywhere else.",
    {"door.cdsl.yaml": f"{_COMPONENT}statemachine: doors.scxml\n", "door.scxml": _RIGHT["door.scxml"]},
    _RIGHT,
)
NOT_XML = Code(
    "RC2202",
    "error",
    "this is not well-formed XML: {reason}",
    "SCXML is XML: every element is closed, attributes are in quotes, and `&` and `<` in a text are `&amp;`, `&lt;`.",
    _file('<state id="closed">\n'),
    _RIGHT,
)
XML_REFUSED = Code(
    "RC2203",
    "error",
    "{what} is not taken",
    "A document type or an entity could make a parser read other files, or write the same text a billion times. SCXML "
    "needs neither.",
    _file(_OPEN, head='<!DOCTYPE scxml [<!ENTITY who SYSTEM "/etc/passwd">]>\n'),
    _RIGHT,
)
XML_TOO_LARGE = Code(
    "RC2204",
    "error",
    "the document is {limit}",
    "No state machine that a person reads is that large; something has written it that should not.",
    _file("<state>" * 120 + "</state>" * 120),
    _RIGHT,
)
NOT_SCXML = Code(
    "RC2205",
    "error",
    "this is no SCXML: it begins with <{name}>",
    "The document's first element is `<scxml>`.",
    {**_RIGHT, "door.scxml": '<statemachine xmlns="http://www.w3.org/2005/07/scxml"/>\n'},
    _RIGHT,
)
NO_NAMESPACE = Code(
    "RC2206",
    "warning",
    "<scxml> has no namespace",
    "The namespace is what tells SCXML from any other XML: `http://www.w3.org/2005/07/scxml`. Other tools will not "
    "take the document without it.",
    {**_RIGHT, "door.scxml": f'<scxml version="1.0" initial="closed">{_OPEN}</scxml>\n'},
    _RIGHT,
)
UNKNOWN_ELEMENT = Code(
    "RC2207",
    "error",
    "<{name}> cannot stand in <{parent}>",
    "These are the elements of SCXML 1.0. Elements of other namespaces, such as the notes of an editor, are left "
    "alone.",
    _file('<state id="closed"><transiton event="open" target="opened"/></state>\n<state id="opened"/>\n'),
    _RIGHT,
)
UNKNOWN_ATTRIBUTE = Code(
    "RC2208",
    "warning",
    "<{element}> has no attribute '{name}'",
    "These are the attributes of SCXML 1.0; what else stands there has no effect. Attributes of other namespaces are "
    "left alone.",
    _file('<state id="closed"><transition event="open" to="opened"/></state>\n'),
    _RIGHT,
)
MISSING_ATTRIBUTE = Code(
    "RC2209",
    "error",
    "<{element}> lacks the attribute '{name}'",
    "The element says nothing without it.",
    _file('<state id="closed"><onentry><raise/></onentry></state>\n'),
    _RIGHT,
)
TWO_ATTRIBUTES = Code(
    "RC2210",
    "error",
    "'{first}' and '{second}' cannot both be given",
    "They say the same thing in two ways: as it stands, and as an expression.",
    _file('<state id="closed"><onentry><send event="a" eventexpr="\'b\'"/></onentry></state>\n'),
    _file('<state id="closed"><onentry><send event="a"/></onentry><transition event="a" target="opened"/></state>\n'
          '<state id="opened"/>\n'),
)
BAD_VALUE = Code(
    "RC2211",
    "error",
    "'{value}' is no value of '{name}'",
    "The attribute has a few values, or a form, that SCXML gives.",
    _file('<state id="closed"><onentry><send event="a" delay="5 minutes"/></onentry>'
          '<transition event="a"/></state>\n'),
    _file('<state id="closed"><onentry><send event="a" delay="300s"/></onentry><transition event="a"/></state>\n'),
)
ONE_TRANSITION = Code(
    "RC2212",
    "error",
    "<{element}> holds exactly one <transition>",
    "It says which state is entered.",
    _file('<state id="closed"><initial/><state id="locked"/></state>\n'),
    _file('<state id="closed"><initial><transition target="locked"/></initial><state id="locked"/></state>\n'),
)
TWICE = Code(
    "RC2213",
    "error",
    "a second <{name}> in <{element}>",
    "There can be one.",
    _file('<state id="closed"><datamodel/><datamodel/></state>\n'),
    _RIGHT,
)
STRAY_TEXT = Code(
    "RC2214",
    "error",
    "'{text}' stands in <{element}>, where no text is meant",
    "SCXML has text only inside of `<script>`, `<assign>`, `<data>` and `<content>`.",
    _file('<state id="closed">opened</state>\n'),
    _RIGHT,
)
BAD_SOURCE = Code(
    "RC2215",
    "error",
    "'{src}' cannot be included: {reason}",
    "What `src` names becomes part of the component when it is compiled: a file beside the document, or below its "
    "folder. Nothing is fetched from elsewhere.",
    _file('<state id="closed"><invoke src="file:/etc/lock.scxml"/></state>\n'),
    {**_file('<state id="closed"><invoke src="file:lock.scxml"/></state>\n'),
     "lock.scxml": '<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0"><final id="locked"/></scxml>\n'},
)
DATAMODEL = Code(
    "RC2216",
    "error",
    "the data model '{name}' is not available in {language}",
    "A component in Python has the data models `null` and `python`, one in C++ has `null`. With `null` (the one that "
    "is meant where none is named), conditions are names of guards, which are methods of the specific worker.",
    _file(_OPEN, ' initial="closed" datamodel="ecmascript"'),
    _file(_OPEN, ' initial="closed" datamodel="python"'),
)
NOT_IN_LANGUAGE = Code(
    "RC2217",
    "error",
    "{what} '{text}' is not of the data model null: {reason}",
    "A condition is the name of a guard, or `In('state')`, joined by `and`, `or`, `not` and parentheses. A value is a "
    "text in quotes, a number, `true` or `false`. A script is a list of names of actions. What is more belongs into "
    "the methods of the specific worker, or into the data model `python`.",
    _file('<state id="closed"><transition event="open" cond="distance &lt; 3" target="opened"/></state>\n'
          '<state id="opened"/>\n'),
    _file('<state id="closed"><transition event="open" cond="near" target="opened"/></state>\n<state id="opened"/>\n'),
)
NEEDS_DATAMODEL = Code(
    "RC2218",
    "error",
    "{what} needs a data model with variables",
    "The data model `null` has no variables: what the machine remembers, it remembers by its states, and the specific "
    "worker's own members hold the rest. A component in Python may say `datamodel=\"python\"`.",
    _file('<datamodel><data id="count" expr="1"/></datamodel>\n' + _OPEN),
    _file('<datamodel><data id="count" expr="1"/></datamodel>\n' + _OPEN, ' initial="closed" datamodel="python"'),
)
PYTHON_SYNTAX = Code(
    "RC2219",
    "warning",
    "{what} is not Python: {reason}",
    "With `datamodel=\"python\"` it is run by the component, which will log the same error each time.",
    _file('<state id="closed"><transition event="open" cond="1 =" target="opened"/></state>\n<state id="opened"/>\n',
          ' initial="closed" datamodel="python"'),
    _file('<state id="closed"><transition event="open" cond="1 == 1" target="opened"/></state>\n<state id="opened"/>\n',
          ' initial="closed" datamodel="python"'),
)
DUPLICATE_STATE = Code(
    "RC2220",
    "error",
    "two states are called '{id}'",
    "Transitions name a state by its id, wherever it stands; so an id is used once in the whole machine.",
    _file('<state id="closed"><transition event="open" target="opened"/></state>\n<state id="opened"/>\n'
          '<state id="opened"/>\n'),
    _RIGHT,
)
UNKNOWN_STATE = Code(
    "RC2221",
    "error",
    "there is no state '{id}'",
    "A transition, `initial`, or `In()` names a state of the same machine.",
    _file('<state id="closed"><transition event="open" target="opend"/></state>\n<state id="opened"/>\n'),
    _RIGHT,
)
STATE_NAME = Code(
    "RC2222",
    "error",
    "'{id}' cannot be the name of a state",
    "Each state has a method in the specific worker, `sm_` and the state's name: so it has letters, digits and "
    "underscores, and does not start with a digit.",
    _file('<state id="half-open"/>\n', ' initial="half-open"'),
    _file('<state id="half_open"/>\n', ' initial="half_open"'),
)
NO_INITIAL = Code(
    "RC2223",
    "error",
    "{what} does not say which of its states it starts in",
    "A state that holds states enters one of them; which, says `initial:`. Only where all are active at once, with "
    "`parallel: true`, there is nothing to choose.",
    inline("  initial: closed\n  states: {closed: {states: {locked: {}, unlocked: {}}}}\n"),
    inline("  initial: closed\n  states:\n    closed:\n      initial: locked\n"
           "      states: {locked: {}, unlocked: {}}\n"
           "      transitions: {locked: {to: unlocked, event: turn}}\n"),
)
IMPLICIT_INITIAL = Code(
    "RC2224",
    "warning",
    "{what} does not say which of its states it starts in; SCXML takes the first one, '{first}'",
    "It is right, but whoever moves a state in the file changes what the machine does.",
    _file(_OPEN, ""),
    _RIGHT,
)
INITIAL_OUTSIDE = Code(
    "RC2225",
    "error",
    "'{id}' does not stand in {what}",
    "What is entered with a state is one of the states in it.",
    _file('<state id="closed" initial="opened"><state id="locked"/></state>\n<state id="opened"/>\n'),
    _file('<state id="closed" initial="locked"><state id="locked"/>'
          '<transition event="open" target="opened"/></state>\n<state id="opened"/>\n'),
)
NOT_TOGETHER = Code(
    "RC2226",
    "error",
    "'{first}' and '{second}' cannot be entered at once",
    "A transition with several targets goes to states that stand in different parts of one `<parallel>`.",
    _file('<state id="closed"><transition event="open" target="opened broken"/></state>\n<state id="opened"/>\n'
          '<state id="broken"/>\n'),
    _RIGHT,
)
UNREACHABLE = Code(
    "RC2227",
    "warning",
    "nothing leads to the state '{id}'",
    "It is neither an initial state nor the target of a transition that can be taken, nor around or beside one: its "
    "handler will never be called.",
    _file('<state id="closed"/>\n<state id="opened"/>\n'),
    _RIGHT,
)
UNHEARD = Code(
    "RC2228",
    "warning",
    "no transition waits for the event '{event}'",
    "The machine sends it to itself, and it is lost.",
    _file('<state id="closed"><onentry><raise event="opne"/></onentry>'
          '<transition event="open" target="opened"/></state>\n<state id="opened"/>\n'),
    _RIGHT,
)
NEVER_SENT = Code(
    "RC2229",
    "warning",
    "nobody sends the event '{event}'{why}",
    "`done.state.X` comes when the state X has reached a final state in it (for a parallel state: in all its parts), "
    "`done.invoke.X` and `error.*` come from the machine itself. All other events are fired by the component's code, "
    "or raised and sent by the machine; where the machine lists the ones that code fires, under `events:`, any other "
    "that the machine does not send itself can never come.",
    _file('<state id="closed"><transition event="done.state.closed" target="opened"/></state>\n<state id="opened"/>\n'),
    _file('<state id="closed" initial="turning"><transition event="done.state.closed" target="opened"/>'
          '<state id="turning"><transition event="turned" target="turned"/></state><final id="turned"/></state>\n'
          '<state id="opened"/>\n'),
    says=("nobody sends the event '{event}'", "nobody sends the event '{event}': {reason}"),
)
EVENT_NAME = Code(
    "RC2230",
    "error",
    "'{event}' cannot be the name of an event",
    "Code fires an event by a method of its name: words of letters, digits, `_` and `-` with dots between them, which "
    "all become `_` in code. A transition may also wait for `*`, or for `door.*`.",
    _file('<state id="closed"><transition event="open!" target="opened"/></state>\n<state id="opened"/>\n'),
    _RIGHT,
)
SAME_IN_CODE = Code(
    "RC2231",
    "error",
    "{first} and {second} would both be called '{name}' in code",
    "States, guards and actions are methods of one class, and events of another.",
    _file('<state id="closed"><transition event="door.open" target="opened"/>'
          '<transition event="door_open" target="opened"/></state>\n<state id="opened"/>\n'),
    _RIGHT,
)
NO_STATE = Code(
    "RC2232",
    "error",
    "the machine has no state",
    "A machine is in one of its states.",
    _file("", ""),
    _RIGHT,
)
ENDLESS = Code(
    "RC2233",
    "error",
    "this goes round for ever: {circle}",
    "Transitions without an event and without a condition are taken at once, so the machine would never come to rest.",
    _file('<state id="closed"><transition target="opened"/></state>\n'
          '<state id="opened"><transition target="closed"/></state>\n'),
    _RIGHT,
)
INLINE_HISTORY = Code(
    "RC2234",
    "error",
    "a history stands for states beside it: it has no {what} of its own",
    "`{history: deep}` (or `shallow`) is not a state: who goes there comes back to where its surroundings were left.",
    inline("  initial: closed\n  states:\n    closed:\n      initial: locked\n      states:\n        locked: {}\n"
           "        last: {history: shallow, entry: [beep]}\n      transitions: {last: locked}\n"),
    INLINE,
)
FINAL_LEFT = Code(
    "RC2235",
    "error",
    "'{id}' is a final state: it has no {what}",
    "A final state ends the state that it stands in, or the machine.",
    inline("  initial: closed\n  final: opened\n  transitions: {closed: opened, opened: closed}\n"),
    inline("  initial: closed\n  final: opened\n  transitions: {closed: opened}\n"),
)
NO_PARENT = Code(
    "RC2236",
    "error",
    "a history stands in a state, not at the top",
    "It remembers where the state that it stands in was left.",
    inline("  initial: closed\n  states: {closed: {}, last: {history: deep}}\n  transitions: {last: closed}\n"),
    INLINE,
)
METHOD_NAME = Code(
    "RC2237",
    "error",
    "'{name}' cannot be the name of a guard or of an action",
    "Guards and actions are methods of the specific worker, so they have neither the name of something that every "
    "worker has, nor a word of Python or C++.",
    inline("  initial: closed\n  states: {opened: {}}\n"
           "  transitions: {closed: {to: opened, event: open, if: default}}\n"),
    inline("  initial: closed\n  states: {opened: {}}\n"
           "  transitions: {closed: {to: opened, event: open, if: wanted, do: killYourSelf}}\n"),
)
