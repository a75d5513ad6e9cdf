"""What requests to the manager say: the bodies of its commands."""

from __future__ import annotations

from typing import Any, TypeVar

import msgspec

from robocomp_yaml.api.editing.changes import DocumentChange
from robocomp_yaml.deploy.operations import KEEP_GOING, ROLL_BACK, STOP_THEM
from robocomp_yaml.diag.errors import Refused

T = TypeVar("T")


class Unknown(Refused):
    """The address names something that is not there."""


class OperationRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """`names` are processes and groups; without one, it is all of the network. `timeout` is in seconds."""

    names: tuple[str, ...] = ()
    on_failure: str = STOP_THEM
    timeout: float | None = None

    def __post_init__(self) -> None:
        if self.on_failure not in (STOP_THEM, ROLL_BACK, KEEP_GOING):
            raise ValueError(f"on_failure is {STOP_THEM}, {ROLL_BACK} or {KEEP_GOING}")


class EditRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """`document` is that of the deployment if it is ''. `based_on` is the version of the document that is meant, ''
    for whatever it is. Without `write`, the change is only shown; with `force`, it is written although it causes
    errors."""

    change: DocumentChange
    document: str = ""
    based_on: str = ""
    write: bool = True
    force: bool = False


class UndoRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """`document` is that of the deployment if it is ''."""

    document: str = ""


class CallRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """`method` is as for `rcyaml call`: `speech.Speech.say`. `arguments` are by their names. `timeout` is in
    seconds."""

    method: str
    arguments: dict[str, Any] = {}
    timeout: float = 10.0


class ParameterRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A parameter of a running process; the document is not changed. `value` is as for `rcyaml param set`."""

    process: str
    parameter: str
    value: str


class PositionsRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """`positions` are pixels from the upper left corner of the picture, by the names of its nodes; null forgets one."""

    positions: dict[str, tuple[float, float] | None]


class PushRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """`hosts` are names of hosts, processes or groups, as for `rcyaml deploy push`; without one, all other hosts."""

    hosts: tuple[str, ...] = ()


class CompletionRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """`text` is the unsaved text of the document. `line` and `column` count characters from 1."""

    path: str
    text: str
    line: int
    column: int


class DiagnoseRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """`text` is the unsaved text of the document. With `graph`, the picture that the network would have is returned,
    too; `closed` are its closed boxes, and `of` is as for `graph`."""

    path: str
    text: str
    graph: bool = False
    closed: tuple[str, ...] = ()
    of: str = "network"


class WriteRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """`text` replaces that of the document. The other keys are those of an edit."""

    path: str
    text: str
    based_on: str = ""
    write: bool = True
    force: bool = False


def read(body: bytes, type_: type[T]) -> T:
    """The request in a body. Raises Refused."""
    try:
        return msgspec.json.decode(body or b"{}", type=type_)
    except (msgspec.MsgspecError, UnicodeDecodeError) as error:
        raise Refused(str(error)) from None
    except RecursionError:
        raise Refused("the request is nested too deeply") from None
