"""Why a call had no result: what the other side raised, as data, and failures on the way, in words."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import Ice
import msgspec

from robocomp_yaml.diag.errors import NoAnswer
from robocomp_yaml.wire.client import NotConnected, OutOfTime, reason_of
from robocomp_yaml.wire.interfaces import Operation
from robocomp_yaml.wire.values import Data

_UNFIT = (Ice.OperationNotExistException, Ice.MarshalException, Ice.EncapsulationException)
_INVISIBLE = dict.fromkeys((0x200B, 0x2060, 0xFEFF))


class Called(msgspec.Struct, frozen=True):
    """Who is called, for messages: `who` at `where`, and what is wanted of it. `not_running` is the hint if nothing
    answers there."""

    who: str
    where: str
    interface: str
    type_id: str
    method: str
    not_running: str = ""


def raised(error: Exception, operation: Operation) -> tuple[str, dict[str, Data]] | None:
    """Name and members of an exception that the other side raised; None if the call failed otherwise."""
    for name, throwable in operation.throws.items():
        if isinstance(error, throwable.kind):
            return name, throwable.members.to_data(error)
    if isinstance(error, Ice.UnknownException):  # and UnknownLocalException, UnknownUserException
        return type(error).__name__, {"unknown": " ".join(error.unknown.translate(_INVISIBLE).split())}
    return None


def no_answer(
    error: Exception, called: Called, limit: float, ids: Callable[[], list[str]], others: Callable[[], list[str]]
) -> NoAnswer:
    """Why a call failed. `ids` returns the type ids of the object that is there, `others` the names of known interfaces
    that are there instead."""
    who, method = f"{called.who} at {called.where}", f"{called.interface}.{called.method}"
    match error:
        case NotConnected():
            where = f"{called.who} cannot be reached at {called.where}"
            if error.error is None:
                plain = called.where.startswith(("tcp ", "ws "))
                what = "another program" + (" or one with TLS (ssl:HOST:PORT)" if plain else "")
                hint = f"it hangs, its host is off, or {what} listens there"
                return NoAnswer(f"{where}: it does not answer within {limit:g} s", hint)
            return NoAnswer(f"{where}: {_why(error.error)}", called.not_running)
        case OutOfTime():
            why = f"{method} of {who} did not return within {limit:g} s"
            return NoAnswer(why, "it hangs, or needs more time: --timeout TIME")
        case Ice.ObjectNotExistException() | Ice.FacetNotExistException():
            what = f"{who} has no object '{Ice.identityToString(error.id)}' for {called.interface}"
            if there := others():
                return NoAnswer(what, f"what serves there is {', '.join(there)}")
            return NoAnswer(what, "another component runs there, or it is not ready yet")
    if isinstance(error, _UNFIT):
        there = [one for one in ids() if one != "::Ice::Object"]
        what = f"{who} does not have {method} as these documents define it: {_unfit(error)}"
        if there and called.type_id not in there:
            return NoAnswer(what, f"what serves there is {there[-1].removeprefix('::').replace('::', '.')}")
        return NoAnswer(what, "compile and build both sides from the same document, then restart them")
    return NoAnswer(f"{who} did not answer {method}: {_why(error)}", "it may have ended: see its log")


def _why(error: Exception) -> str:
    if isinstance(error, Ice.ProtocolException):
        return f"what listens there does not speak Ice ({reason_of(error)})"
    if isinstance(error, Ice.ConnectionLostException | Ice.CloseConnectionException):
        return "the connection was closed"
    return reason_of(error)


def _unfit(error: Any) -> str:
    if isinstance(error, Ice.OperationNotExistException):
        return f"it has no method '{error.operation}'"
    return f"the values have another type ({type(error).__name__.removesuffix('Exception')})"
