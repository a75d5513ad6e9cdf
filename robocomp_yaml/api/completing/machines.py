"""Completion of states and events of a machine in a component document."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.api.completing.places import MARK, TypedPlace
from robocomp_yaml.api.completing.proposal import Proposal
from robocomp_yaml.naming.names import STATE
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence


def proposals(place: TypedPlace) -> Iterator[Proposal]:
    """What can stand below `statemachine:`."""
    machine = place.root.get("statemachine")
    keys = place.keys[1:]
    if machine is None or not keys:
        return
    last = next((key for key in reversed(keys) if key), "")
    is_state = (
        last in ("initial", "final", "to")
        or (len(keys) > 1 and keys[-2:][0] == "transitions")
        or ("transitions" in keys and not keys[-1])
    )
    if place.is_key and last == "transitions":
        yield from (Proposal(name, STATE, "state") for name in _states(machine))
    elif not place.is_key and last == "event":
        yield from (Proposal(name, "event", "event") for name in _texts(machine.get("events")))
    elif not place.is_key and is_state and last not in ("events", "do", "if"):
        yield from (Proposal(name, STATE, "state") for name in _states(machine))


def _states(node: Node) -> list[str]:
    found: dict[str, None] = {}
    if isinstance(states := node.get("states"), Mapping):
        for key, state in states.items():
            found[key.lexeme] = None
            found |= dict.fromkeys(_states(state))
    if isinstance(transitions := node.get("transitions"), Mapping):
        found |= dict.fromkeys(key.lexeme for key, _ in transitions.items())
    for end in ("initial", "final"):
        found |= dict.fromkeys(_texts(node.get(end)))
    return [name for name in found if name and name != MARK]


def _texts(node: Node | None) -> list[str]:
    listed = node.items if isinstance(node, Sequence) else [node]
    return [one.lexeme for one in listed if isinstance(one, Scalar) and one.lexeme != MARK]
