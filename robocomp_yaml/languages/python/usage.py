"""What the worker offers to code in Python, and which of that the user's code uses.

The code is read with Python's own parser. A file counts if `specificworker.py` imports it, directly or not.
"""

from __future__ import annotations

import ast
import re
import warnings
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import partial

from msgspec import structs

from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import likeness, suggest
from robocomp_yaml.emit.lowering import ports as lowering
from robocomp_yaml.emit.usage import offer as offers
from robocomp_yaml.emit.usage.code import MODULES, SERVED, WORKER, CodeUsage, Slip
from robocomp_yaml.emit.usage.judge import is_proxy
from robocomp_yaml.emit.usage.kinds import NUMBERS
from robocomp_yaml.emit.usage.offer import Offer, OfferedMember, WorkerOffer
from robocomp_yaml.emit.usage.types import OfferedTypes
from robocomp_yaml.languages.python import LANGUAGE
from robocomp_yaml.languages.python.names import PORTS, WORKER_ATTRIBUTES, module_variable, parameters, python_name
from robocomp_yaml.languages.python.types import hint_of
from robocomp_yaml.languages.python.usage_classes import UserClasses, classes_of
from robocomp_yaml.languages.python.usage_files import FileUsage, UsageReader
from robocomp_yaml.languages.python.usage_signatures import functions, methods
from robocomp_yaml.languages.python.usage_slips import slips
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.model import machine_names
from robocomp_yaml.model.interface import Map, Member, Method, Sequence, TypeRef
from robocomp_yaml.parameters.types import RecordType

_MAIN = "specificworker.py"
_RELEVANT = (ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef, ast.Import, ast.ImportFrom)
_REPLACED = ("genericworker.py", "interfaces.py")
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
    natives = {name: _members_of(*types) for name, types in _NATIVES.items()} if is_own else {}
    lists = _OF_NO_LIST if is_own else {}
    types = OfferedTypes(python_name, _is_of_every_struct, _is_of_every_exception, lists, natives)
    if is_own:
        members |= _of_worker(linked)
    proxies = offers.OfferedProxies(
        PORTS.called, _is_of_every_proxy, partial(types.result, tuples=True), keywords=_keywords, future=_future,
        of_ice=_OF_ICE,
    )  # fmt: skip
    members |= proxies.every(ports)
    if is_own:
        of_parameters = {**natives, offers.LIST: _members_of(tuple)}
        values = offers.record(linked.parameters.parameters.root, LANGUAGE.in_code, natives=of_parameters)
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
    modules = offers.modules(
        linked, module_variable, python_name, _is_in_interfaces, types.of_definition, classes=True, prx=proxies
    )  # fmt: skip
    if is_own and not linked.broken:
        modules = _as_hints(linked, modules, types)
    if not is_own:  # RoboComp's tool also has the sequences beside the modules
        beside = dict.fromkeys(_sequences(linked), OfferedMember())
        modules = structs.replace(modules, members={**beside, **modules.members})
    return WorkerOffer(
        {
            WORKER: Offer(offers.WORKER, linked.component.name, members, is_complete=is_own),
            MODULES: modules,
            SERVED: types.arguments(ports),
        },
        served,
        offers.handlers(machine) if machine else (),
        offers.states(machine) if machine else (),
        offers.answering(ports),
        is_exact=True,
    )


def _of_worker(linked: LinkedComponent) -> dict[str, OfferedMember]:
    """The members that the worker of every component has."""
    period = linked.parameters.parameters.root.member("period")
    group = period.type if period is not None else None
    compute = group.member("compute") if isinstance(group, RecordType) else None

    def method(name: str, *inputs: str) -> OfferedMember:
        number = TypeRef(text="float")
        members = tuple(Member(name=one, type=number) for one in inputs)
        return OfferedMember(
            least=len(inputs), most=len(inputs), keywords=frozenset(inputs), inputs=members,
            signature=f"{name}({', '.join(inputs)})",
        )  # fmt: skip

    return {
        "log": OfferedMember(Offer(offers.TOOL, "log", dict.fromkeys(_OF_LOGS, OfferedMember()))),
        "mutex": OfferedMember(Offer(offers.TOOL, "mutex", dict.fromkeys(("acquire", "release"), OfferedMember()))),
        "getPeriod": method("getPeriod"),
        "killYourSelf": method("killYourSelf"),
        "mayTake": method("mayTake", "seconds"),
        "setPeriod": structs.replace(
            method("setPeriod", "period"), inputs=(), parameter=compute, path="period.compute"
        ),
    }


def _future(result: Offer | None) -> Offer:
    """What an asynchronous call returns."""
    members = dict.fromkeys(_OF_FUTURES, OfferedMember())
    members["result"] = OfferedMember(result=result)
    return Offer(offers.FUTURE, "the future", members)


def _members_of(*types: type) -> dict[str, OfferedMember]:
    return {name: OfferedMember() for type_ in types for name in dir(type_) if not name.startswith("_")}


_NATIVES: dict[str, tuple[type, ...]] = {
    **dict.fromkeys(("bool", *NUMBERS), (int, float)), "string": (str,), offers.LIST: (list,), offers.MAP: (dict,)
}  # fmt: skip


def _as_hints(linked: LinkedComponent, modules: Offer, types: OfferedTypes) -> Offer:
    """The modules with sequences and maps for annotations only: Ice makes no classes of them."""
    members = dict(modules.members)
    for scope in linked.modules():
        module = members[module_variable(scope.module.name)]
        assert module.value is not None
        hints = {
            python_name(one.name): OfferedMember(
                instead=f"in Python, it is {hint_of(one, scope)}", instance=types.of_definition(one, scope)
            )
            for one in scope.module.definitions if isinstance(one, (Map, Sequence))
        }  # fmt: skip
        value = structs.replace(module.value, members={**module.value.members, **hints})
        members[module_variable(scope.module.name)] = structs.replace(module, value=value)
    return structs.replace(modules, members=members)


def _sequences(linked: LinkedComponent) -> list[str]:
    return [
        python_name(one.name) for scope in linked.modules() for one in scope.module.definitions
        if isinstance(one, Sequence)
    ]  # fmt: skip


def _keywords(method: Method) -> Iterator[str]:
    return parameters((member.name for member in method.inputs), ())


def _is_of_every_proxy(name: str) -> bool:
    """Methods of Ice, and Ice's asynchronous variants of the operations, which it makes of their names."""
    if name.startswith("ice_"):
        near = suggest(name, _OF_ICE)  # another one may be of a later Ice
        return near is None or likeness(name, near) < _NEAR
    return name.startswith(("begin_", "end_", "_")) or name in _OF_PROXIES


def _is_of_every_struct(name: str) -> bool:
    return name.startswith("_")


def _is_of_every_exception(name: str) -> bool:
    return name.startswith(("_", "ice_")) or hasattr(Exception, name) or name == "unknown"


_OF_FUTURES = (
    "add_done_callback add_done_callback_async add_sent_callback add_sent_callback_async cancel cancelled communicator "
    "connection done exception is_sent is_sent_synchronously operation proxy result running sent set_exception "
    "set_result"
).split()
_OF_NO_LIST = {
    "push_back": "write append()", "emplace_back": "write append()", "add": "write append()", "size": "write len()",
    "length": "write len()", "at": "write an index", "front": "write [0]", "back": "write [-1]",
    "isEmpty": "write `not`",
}  # fmt: skip
"""Names that lists of C++ and Java have, and what Python has instead."""
_OF_LOGS = (
    "critical debug error exception fatal info log warn warning addFilter addHandler callHandlers disabled filter "
    "filters findCaller getChild getChildren getEffectiveLevel handle handlers hasHandlers isEnabledFor level "
    "makeRecord manager name parent propagate removeFilter removeHandler root setLevel"
).split()

_OF_LOG = frozenset("critical debug error exception info log warning".split())
_NEAR = 0.85  # similarity of a method of Ice that is surely misspelled
_OF_ICE = {
    f"ice_{name}": True for name in (
        "adapterId batchDatagram batchOneway collocationOptimized compress connectionCached connectionId context "
        "datagram encodingVersion endpointSelection endpoints fixed invocationTimeout locator locatorCacheTimeout "
        "oneway preferSecure router secure timeout twoway"
    ).split()
} | {
    f"ice_{name}": False for name in (
        "checkedCast facet flushBatchRequests flushBatchRequestsAsync getAdapterId getCachedConnection getCommunicator "
        "getCompress getConnection getConnectionAsync getConnectionId getContext getEncodingVersion "
        "getEndpointSelection getEndpoints getFacet getIdentity getInvocationTimeout getLocator "
        "getLocatorCacheTimeout getRouter getTimeout id idAsync identity ids idsAsync invoke invokeAsync isA isAAsync "
        "isBatchDatagram isBatchOneway isCollocationOptimized isConnectionCached isDatagram isFixed isOneway "
        "isPreferSecure isSecure isTwoway ping pingAsync staticId toString uncheckedCast"
    ).split()
}  # fmt: skip
"""Methods of every proxy, and whether they return a proxy of the same type."""
_OF_PROXIES = frozenset(("checkedCast", "uncheckedCast"))


def _is_in_interfaces(name: str) -> bool:
    return name.startswith("_") or name in ("Ice", "absent", "lists", "load", "os")


def read(files: Mapping[str, str], linked: LinkedComponent, worker: WorkerOffer) -> CodeUsage:
    """The use that the files below src/ make of the worker, by their paths there."""
    try:
        return _read(files, linked, worker)
    except RecursionError:  # data that is written as code
        return CodeUsage()


def _read(files: Mapping[str, str], linked: LinkedComponent, worker: WorkerOffer) -> CodeUsage:
    is_robocomp = bool(linked.component.compatibility)
    if is_robocomp:  # what RoboComp's own tool left in src/ is not used
        files = {path: text for path, text in files.items() if path not in _REPLACED}
    trees: dict[str, ast.Module] = {}
    nodes: dict[str, list[ast.AST]] = {}
    faults: list[tuple[str, Span]] = []
    imported, todo = {_MAIN}, [_MAIN]
    while todo:
        path = todo.pop()
        if path not in files or path in trees:
            continue
        try:
            trees[path] = parsed(files[path])
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                compile(trees[path], path, "exec", dont_inherit=True)
        except SyntaxError as error:
            if not _is_wrong(path, files[path], error):
                return CodeUsage()  # an older or a newer Python accepts it
            line, column = error.lineno or 1, error.offset or 1
            faults.append((error.msg, Span(path, line, column, line, max(column + 1, error.end_offset or 0))))
            trees[path] = ast.Module([], [])
        except (ValueError, RecursionError, MemoryError):
            return CodeUsage()
        nodes[path] = [node for node in ast.walk(trees[path]) if isinstance(node, _RELEVANT)]
        found, is_dynamic = _imported(nodes[path], files)
        imported.update(found if path in imported else ())
        todo += files if is_dynamic or "__import__" in files[path] else found
    if faults:
        return CodeUsage(faults=tuple(faults))
    classes = classes_of(nodes)
    found_slips = () if is_robocomp else tuple(_slips(files, trees, imported, classes, worker))
    if not classes.workers:
        return CodeUsage(slips=found_slips)
    modules = frozenset(worker.roots[MODULES].members)
    stored, served = _stored(trees), worker.roots[SERVED].members
    signatures = {name: one for name, one in methods(trees).items() if name not in stored}
    own = {path: functions(tree) for path, tree in trees.items()}
    every = {
        path: UsageReader(
            path, files[path], classes, modules, served, worker.answering, stored, signatures, own[path], is_robocomp
        ).read(tree)
        for path, tree in trees.items()
    }
    whole = _together(every.values(), [one for path, one in every.items() if path in imported], classes)
    return structs.replace(whole, slips=found_slips, signatures=signatures, functions=own)


def _stored(trees: Mapping[str, ast.Module]) -> Counter[str]:
    """How often each attribute is set in all files, except to None."""
    found: Counter[str] = Counter()
    for tree in trees.values():
        for node in ast.walk(tree):
            if isinstance(node, (ast.Assign, ast.AnnAssign)):
                targets = node.targets if isinstance(node, ast.Assign) else [node.target]
                if isinstance(node.value, ast.Constant) and node.value.value is None:
                    found.subtract(one.attr for one in targets if isinstance(one, ast.Attribute))
            if isinstance(node, ast.Attribute) and isinstance(node.ctx, (ast.Store, ast.Del)):
                found[node.attr] += 1
    return found


def _slips(
    files: Mapping[str, str], trees: Mapping[str, ast.Module], imported: Collection[str], classes: UserClasses,
    worker: WorkerOffer,
) -> Iterator[Slip]:  # fmt: skip
    members = worker.roots[WORKER].members
    proxies = {name: one.value for name, one in members.items() if one.value is not None and is_proxy(name)}
    others = ("events", "log", "parameters", "statemachine")
    attributes = {*proxies, *(name for name in others if name in members)}
    modules = worker.roots[MODULES]
    methods: dict[str, Collection[str]] = {name: set(proxy.members) for name, proxy in proxies.items()}
    if "events" in members and (events := members["events"].value) is not None:
        methods["events"] = set(events.members)
    methods |= {"log": _OF_LOG, "parameters": set(_LIVE)}
    names = (*worker.roots[SERVED].members, *worker.handlers, "compute", "initialize", "initializeGui")
    called = {name: len(worker.answering.get(name, ())) for name in names}
    for path in sorted(imported & trees.keys()):
        yield from slips(path, files[path], trees[path], classes.workers, attributes, methods, modules.members, called)


def parsed(text: str) -> ast.Module:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ast.parse(text)


def _is_wrong(path: str, text: str, error: SyntaxError) -> bool:
    """Whether no other version of Python accepts it: the second parser, which knows several, sees an error, too, or
    all versions have the rule."""
    from robocomp_yaml.languages.python.code import read as read_code  # needed only for errors

    code = read_code(path, text)
    is_of_all = isinstance(error, IndentationError) or _OF_ALL.match(error.msg) is not None
    return code.faults > 0 or (is_of_all and code.older is None)


_OF_ALL = re.compile(
    "positional argument follows|cannot assign to|cannot delete|keyword argument repeated|expression cannot contain "
    "assign|'(return|yield|yield from|await)' outside|'break' outside|'continue' not properly|duplicate argument|"
    "non-default argument follows|parameter without a default follows|no binding for nonlocal|"
    "name .* (is used prior to|is assigned to before) (global|nonlocal)|name .* is parameter and|"
    r"from __future__ imports must|import \* only allowed|nonlocal declaration not allowed"
)
"""Errors of syntax that every version of Python reports, and that its grammar alone does not show."""


def _imported(nodes: Iterable[ast.AST], files: Collection[str]) -> tuple[list[str], bool]:
    """The user's files that a module imports; and whether it may import others, by names that are computed."""
    found: list[str] = []
    is_dynamic = False
    for node in nodes:
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
            is_dynamic |= "importlib" in names
        elif isinstance(node, ast.ImportFrom):
            module = node.module or ""
            names = [module, *(f"{module}.{alias.name}" for alias in node.names)]
            is_dynamic |= node.level > 0 or module == "importlib"
        for name in names:
            parts = name.split(".")
            heads = ("/".join(parts[:end]) for end in range(1, len(parts) + 1))
            paths = (path for head in heads for path in (f"{head}.py", f"{head}/__init__.py"))
            found += [path for path in paths if path in files]
    return found, is_dynamic


def _together(every: Iterable[FileUsage], imported: Iterable[FileUsage], classes: UserClasses) -> CodeUsage:
    """The use of all files. Files that may not be part of the program only count for what they define."""
    known, mine = list(every), list(imported)
    return CodeUsage(
        chains=tuple(chain for one in mine for chain in one.chains),
        methods=tuple(word for one in mine for word in one.methods),
        own=classes.own.union(*(one.stored for one in known)),
        texts=frozenset().union(*(one.texts for one in known)),
        returned=tuple(one for file in mine for one in file.returned),
        is_open=classes.is_open or any(one.is_open for one in known),
        is_shared=any(one.is_shared for one in known),
    )
