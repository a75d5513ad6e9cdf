"""What the worker offers to code in Python, and which of that the user's code uses.

The code is read with Python's own parser. A file counts if `specificworker.py` imports it, directly or not.
"""

from __future__ import annotations

import ast
import warnings
from collections.abc import Iterator, Mapping

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.lowering import ports as lowering
from robocomp_yaml.emit.usage import offer as offers
from robocomp_yaml.emit.usage.code import MODULES, WORKER, CodeUsage
from robocomp_yaml.emit.usage.offer import Offer, OfferedMember, WorkerOffer
from robocomp_yaml.languages.python import LANGUAGE
from robocomp_yaml.languages.python.names import PORTS, WORKER_ATTRIBUTES, module_variable, parameters, python_name
from robocomp_yaml.languages.python.usage_classes import classes_of
from robocomp_yaml.languages.python.usage_files import FileUsage, UsageReader
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.model import machine_names
from robocomp_yaml.model.interface import Method

_MAIN = "specificworker.py"
_LIVE = {
    "set": OfferedMember(least=2, most=2, keywords=frozenset(("path", "value")), takes_path=True,
                         signature="set(path, value)"),
    "change": OfferedMember(least=1, most=1, keywords=frozenset(("values",)), takes_path=True,
                            signature="change({path: value, ...})"),
    "listen": OfferedMember(least=1, most=1, keywords=frozenset(("listener",)), signature="listen(listener)"),
}  # fmt: skip


def offer(linked: LinkedComponent) -> WorkerOffer:
    """What the worker of a component offers."""
    ports, machine = lowering.lower(linked, PORTS), linked.machine
    is_own = not linked.component.compatibility
    members: dict[str, OfferedMember] = {name: OfferedMember() for name in WORKER_ATTRIBUTES} if is_own else {}
    members |= offers.proxies(ports, PORTS.called, _is_of_every_proxy, outputs=False, keywords=_keywords)
    if is_own:
        values = offers.record(linked.parameters.parameters.root, LANGUAGE.in_code)
        members["parameters"] = OfferedMember(
            Offer(offers.PARAMETERS, linked.component.name,
                  {**values.members, **_LIVE, "now": OfferedMember(values)})
        )  # fmt: skip
    if machine:
        is_in = OfferedMember(least=1, most=1, is_state=True)
        others = OfferedMember()
        running = {"is_in": is_in, "states": others, "event": others, "fire": others}
        members["events"] = OfferedMember(offers.events(machine, python_name))
        members["statemachine" if is_own else machine_names.robocomp_machine(machine)] = OfferedMember(
            Offer(offers.OTHER, "", running, is_complete=False)
        )
        handled = (*offers.handlers(machine), *(one.name for one in machine_names.guards(machine)))
        members |= dict.fromkeys((*handled, *(one.name for one in machine_names.actions(machine))), others)
    served = offers.served(ports)
    members |= {name: OfferedMember() for one in served for name in one.methods if name not in members}
    return WorkerOffer(
        {
            WORKER: Offer(offers.WORKER, linked.component.name, members, is_complete=is_own),
            MODULES: offers.modules(linked, module_variable, python_name, _is_in_interfaces),
        },
        served,
        offers.handlers(machine) if machine else frozenset(),
        offers.states(machine) if machine else frozenset(),
    )


def _keywords(method: Method) -> Iterator[str]:
    return parameters((member.name for member in method.inputs), ())


def _is_of_every_proxy(name: str) -> bool:
    """Methods of Ice, and Ice's asynchronous variants of the operations, which it makes of their names."""
    return name.startswith(("ice_", "begin_", "end_", "_")) or name.endswith("Async") or name in _OF_PROXIES


_OF_PROXIES = frozenset(("checkedCast", "uncheckedCast"))


def _is_in_interfaces(name: str) -> bool:
    return name.startswith("_") or name in ("Ice", "absent", "lists", "load", "os")


def read(files: Mapping[str, str], linked: LinkedComponent, worker: WorkerOffer) -> CodeUsage:
    """The use that the files below src/ make of the worker, by their paths there."""
    trees, faults = {}, []
    todo = [_MAIN]
    while todo:
        path = todo.pop()
        if path not in files or path in trees:
            continue
        try:
            trees[path] = parsed(files[path])
        except SyntaxError as error:
            if not _is_wrong(path, files[path]):
                return CodeUsage()  # an older or a newer Python accepts it
            line, column = error.lineno or 1, error.offset or 1
            faults.append((error.msg, Span(path, line, column, line, max(column + 1, error.end_offset or 0))))
            trees[path] = ast.Module([], [])
        except (ValueError, RecursionError, MemoryError):
            return CodeUsage()
        todo += _imported(trees[path], files)
    if faults:
        return CodeUsage(faults=tuple(faults))
    is_robocomp = bool(linked.component.compatibility)
    found = classes_of(trees)
    if not found.workers:
        return CodeUsage()
    modules = frozenset(worker.roots[MODULES].members)
    every = [UsageReader(path, files[path], found, modules, is_robocomp).read(tree) for path, tree in trees.items()]
    return _together(every, found.own, is_open=found.is_open)


def parsed(text: str) -> ast.Module:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ast.parse(text)


def _is_wrong(path: str, text: str) -> bool:
    """Whether the second parser sees an error, too."""
    from robocomp_yaml.languages.python.code import read as read_code  # needed only for errors

    return read_code(path, text).faults > 0


def _imported(tree: ast.Module, files: Mapping[str, str]) -> Iterator[str]:
    """The user's files that a module imports; all of them if it imports by names that are computed."""
    for node in ast.walk(tree):
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
            if "importlib" in names:
                yield from files
        elif isinstance(node, ast.ImportFrom) and not node.level:
            module = node.module or ""
            names = [module, *(f"{module}.{alias.name}" for alias in node.names)]
        elif isinstance(node, ast.ImportFrom) or (isinstance(node, ast.Name) and node.id == "__import__"):
            yield from files
        for name in names:
            parts = name.split(".")
            for end in range(1, len(parts) + 1):
                head = "/".join(parts[:end])
                yield from (path for path in (f"{head}.py", f"{head}/__init__.py") if path in files)


def _together(every: list[FileUsage], own: frozenset[str], *, is_open: bool) -> CodeUsage:
    joined = CodeUsage(own=own, is_open=is_open)
    return msgspec.structs.replace(
        joined,
        chains=tuple(chain for one in every for chain in one.chains),
        methods=tuple(word for one in every for word in one.methods),
        own=own.union(*(one.stored for one in every)),
        texts=frozenset().union(*(one.texts for one in every)),
        is_open=is_open or any(one.is_open for one in every),
        is_shared=any(one.is_shared for one in every),
    )
