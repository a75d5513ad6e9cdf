"""The chains of names in one file of Python: `self.mouth_proxy.move(pose)`, also through variables bound once."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterable, Mapping
from functools import cached_property

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.usage.code import MODULES, SETTINGS, WORKER, Arguments, Chain, Constant, Step, Word
from robocomp_yaml.languages.python.syntax import (
    all_names,
    annotations_of,
    constant,
    imports_all,
    names_of,
    parameters_of,
)
from robocomp_yaml.languages.python.usage_classes import UserClasses

_Function = (ast.FunctionDef, ast.AsyncFunctionDef)
# A worker that these get is not changed.
_HARMLESS = frozenset("bool callable getattr hasattr id isinstance print repr str super type QTimer QThread".split())


class Binding(msgspec.Struct, frozen=True):
    """What a variable is bound to: the beginning of a chain, or an expression; `is_element`: an element of it."""

    root: str = ""
    steps: tuple[Step, ...] = ()
    value: ast.expr | None = None
    is_element: bool = False


Frame = Mapping[str, Binding | None]
_SELF = Binding(WORKER)


class FileUsage(msgspec.Struct):
    chains: list[Chain] = []
    methods: list[Word] = []
    stored: set[str] = set()
    texts: set[str] = set()
    is_open: bool = False
    is_shared: bool = False


class UsageReader:
    def __init__(
        self, path: str, text: str, classes: UserClasses, modules: frozenset[str], is_robocomp: bool
    ) -> None:  # fmt: skip
        self._path, self._text, self._classes = path, text, classes
        self._modules, self._is_robocomp = modules, is_robocomp
        self._sources = {"generated.interfaces", *(("interfaces",) if is_robocomp else ())}
        self._found = FileUsage()
        self._caught: frozenset[str] = frozenset()
        self._rebound: frozenset[str] = frozenset()
        self._again: set[str] = set()  # the parameters that the last scope binds again

    @cached_property
    def _lines(self) -> list[str]:
        return re.compile("\r\n|\r|\n").split(self._text)

    def read(self, tree: ast.Module) -> FileUsage:
        if "global " in self._text or "nonlocal " in self._text:
            scopes = (node for node in ast.walk(tree) if isinstance(node, (ast.Global, ast.Nonlocal)))
            self._rebound = frozenset(name for node in scopes for name in node.names)
        frame = self._frame(tree.body)
        if any(imports_all(node, self._sources | {"genericworker"}) for node in tree.body):
            known = {name: Binding(MODULES, (Step(Word(name, Span(self._path))),)) for name in self._modules}
            frame = {**known, **frame}
        self._visit_all(tree.body, (frame,))
        return self._found

    # Scopes

    def _frame(self, body: Iterable[ast.AST], arguments: ast.arguments | None = None) -> dict[str, Binding | None]:
        """The variables of a scope, with what those are that are bound once."""
        counts: Counter[str] = Counter()
        values: dict[str, Binding] = {}
        given = [argument.arg for argument in parameters_of(arguments)]
        counts.update((*given, *given))
        todo = list(body)
        while todo:
            node = todo.pop()
            match node:
                case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef():
                    counts[node.name] += 1
                    continue
                case ast.Lambda():
                    continue
                case ast.Name(ctx=ast.Store() | ast.Del()):
                    counts[node.id] += 1
                case ast.Import() | ast.ImportFrom():
                    for alias in node.names:
                        name = alias.asname or alias.name.partition(".")[0]
                        counts[name] += 1
                        if (made := self._imported(node, alias)) is not None:
                            values[name] = made
                case ast.ExceptHandler(name=str(name)) | ast.MatchAs(name=str(name)) | ast.MatchStar(name=str(name)):
                    counts[name] += 1
                case ast.Assign(targets=[ast.Name(id=name)], value=value):
                    values[name] = Binding(value=value)
                case ast.AnnAssign(target=ast.Name(id=name), value=ast.expr() as value):
                    values[name] = Binding(value=value)
                case (
                    ast.For(target=ast.Name(id=name), iter=value)
                    | ast.comprehension(target=ast.Name(id=name), iter=value)
                ):
                    values[name] = Binding(value=value, is_element=True)
            todo += ast.iter_child_nodes(node)
        self._again = {name for name in given if counts[name] > 2}
        return {
            name: values.get(name) if count == 1 and name not in self._rebound else None
            for name, count in counts.items()
        }

    def _imported(self, node: ast.Import | ast.ImportFrom, alias: ast.alias) -> Binding | None:
        """What an import binds, if it is one of the generated interfaces."""
        if isinstance(node, ast.Import):
            is_whole = alias.name in self._sources and (alias.asname or "." not in alias.name)
            return Binding(MODULES) if is_whole else None
        if node.module == "generated" and alias.name == "interfaces":
            return Binding(MODULES)
        if node.module in self._sources and not node.level and alias.name != "*":
            return Binding(MODULES, (Step(self._word(alias.name, alias, alias.col_offset)),))
        return None

    def _lookup(self, name: str, frames: tuple[Frame, ...], depth: int = 0) -> tuple[str, tuple[Step, ...]] | None:
        """Root and steps that a variable stands for."""
        for index in range(len(frames) - 1, -1, -1):
            if name in frames[index]:
                bound = frames[index][name]
                if bound is None or name in self._rebound or depth > 8:
                    return None
                if bound.value is None:
                    return bound.root, bound.steps
                chain = self._chain(bound.value, frames[: index + 1], depth + 1)
                if chain is None:
                    return None
                return chain[0], (*chain[1], _ELEMENT) if bound.is_element else chain[1]
        return None

    # Statements and expressions

    def _visit_all(self, nodes: Iterable[ast.AST], frames: tuple[Frame, ...]) -> None:
        for node in nodes:
            self._visit(node, frames)

    def _visit(self, node: ast.AST, frames: tuple[Frame, ...]) -> None:
        match node:
            case ast.Attribute() | ast.Call() | ast.Subscript():
                self._expression(node, frames)
            case ast.Constant(value=str(text)):
                self._found.texts.add(text)
            case ast.Name(id=name):
                found = self._lookup(name, frames)
                self._found.is_shared |= found is not None and found == (WORKER, ())
                self._found.is_open |= name in ("exec", "eval", "vars")
            case ast.FunctionDef() | ast.AsyncFunctionDef():
                self._function(node, frames)
            case ast.Lambda():
                self._visit(node.body, (*frames, self._frame([node.body], node.args)))
            case ast.ClassDef():
                self._class(node, frames)
            case ast.Assign(targets=targets, value=value):
                for target in targets:
                    self._target(target, value, frames)
                self._visit_value(value, frames)
            case ast.AnnAssign(target=target, value=ast.expr() as value):
                self._target(target, value, frames)
                self._visit_value(value, frames)
            case ast.If(test=ast.Constant(value=value), orelse=orelse) if not value:
                self._visit_all(orelse, frames)
            case ast.If(test=ast.Name(id="TYPE_CHECKING"), orelse=orelse):
                self._visit_all(orelse, frames)
            case ast.Try(body=body):
                names = {name for handler in node.handlers for name in names_of(handler.type)}
                self._guarded(body, names, frames)
                self._visit_all((*node.handlers, *node.orelse, *node.finalbody), frames)
            case ast.With(items=items, body=body):
                self._visit_all(items, frames)
                calls = [item.context_expr for item in items if isinstance(item.context_expr, ast.Call)]
                names = {name for call in calls if "suppress" in names_of(call.func) for name in all_names(call.args)}
                self._guarded(body, names, frames)
            case ast.ImportFrom():
                for alias in node.names:
                    made = self._imported(node, alias)
                    if made is not None and made.steps:
                        self._add(Chain(made.root, made.steps, caught=self._caught | self._probed()))
            case _:
                self._visit_all(ast.iter_child_nodes(node), frames)

    def _probed(self) -> frozenset[str]:
        """An import that may fail is one that tries whether something exists."""
        return frozenset(("AttributeError",)) if "ImportError" in self._caught else frozenset()

    def _visit_value(self, value: ast.expr, frames: tuple[Frame, ...]) -> None:
        """An assigned value. Another name of the worker is followed, unless it is an attribute of something."""
        if not isinstance(value, ast.Name):
            self._visit(value, frames)

    def _guarded(self, body: list[ast.stmt], names: set[str], frames: tuple[Frame, ...]) -> None:
        before, self._caught = self._caught, self._caught | names
        self._visit_all(body, frames)
        self._caught = before

    def _function(self, node: ast.FunctionDef | ast.AsyncFunctionDef, frames: tuple[Frame, ...]) -> None:
        self._visit_all((*node.decorator_list, *node.args.defaults, *filter(None, node.args.kw_defaults)), frames)
        self._visit_all(annotations_of(node), frames)
        frame = self._frame(node.body, node.args)
        self._visit_all(node.body, (*frames, frame))

    def _class(self, node: ast.ClassDef, frames: tuple[Frame, ...]) -> None:
        is_worker = node.name in self._classes.workers and len(frames) == 1
        self._visit_all((*node.decorator_list, *(word.value for word in node.keywords)), frames)
        for statement in node.body:
            if is_worker and isinstance(statement, _Function):
                self._method(statement, frames)
            else:
                self._visit(statement, frames)

    def _method(self, node: ast.FunctionDef | ast.AsyncFunctionDef, frames: tuple[Frame, ...]) -> None:
        line = self._lines[node.lineno - 1] if node.lineno <= len(self._lines) else ""
        found = re.compile(rf"def\s+({re.escape(node.name)})\b").search(line)
        if found:
            start = found.start(1) + 1
            word = Word(node.name, Span(self._path, node.lineno, start, node.lineno, start + len(node.name)))
            self._found.methods.append(word)
        self._visit_all((*node.decorator_list, *node.args.defaults, *annotations_of(node)), frames)
        frame = self._frame(node.body, node.args)
        again = self._again
        first = next(iter([*node.args.posonlyargs, *node.args.args]), None)
        decorators = {name for one in node.decorator_list for name in names_of(one)}
        if first is not None and not decorators & {"staticmethod", "classmethod"} and first.arg not in again:
            frame[first.arg] = _SELF
        if self._is_robocomp:
            for argument in node.args.args[1:]:
                is_params = node.name == "setParams" or argument.arg == "configData"
                if is_params and argument.arg not in again:
                    frame[argument.arg] = Binding(SETTINGS)
        self._visit_all(node.body, (*frames, frame))

    def _target(self, target: ast.expr, value: ast.expr, frames: tuple[Frame, ...]) -> None:
        if isinstance(target, (ast.Attribute, ast.Subscript)):
            self._expression(target, frames, self._constant(value))
        else:
            self._visit_all(ast.iter_child_nodes(target), frames)
            if isinstance(value, ast.Name) and not isinstance(target, ast.Name):
                self._visit(value, frames)

    def _expression(
        self, node: ast.expr, frames: tuple[Frame, ...], value: Constant | None = None
    ) -> None:  # fmt: skip
        """Records the chain that ends here, and visits what is in it: arguments, indices, and its beginning."""
        chain = self._chain(node, frames)
        is_assigned = isinstance(getattr(node, "ctx", None), (ast.Store, ast.Del))
        keys: set[int] = set()
        if chain is not None and chain[0] == SETTINGS:
            steps = _literal_head(chain[1])
            if steps and not is_assigned:
                self._add(Chain(SETTINGS, steps, caught=self._caught))
        elif chain is not None and chain[1]:
            self._add(Chain(*chain, is_assigned=is_assigned, constant=value, caught=self._caught))
        now: ast.expr = node
        while True:
            match now:
                case ast.Attribute(value=inner):
                    if isinstance(now.ctx, (ast.Store, ast.Del)):
                        self._found.stored.add(now.attr)
                    self._found.is_open |= now.attr == "__dict__"
                    now = inner
                case ast.Subscript(value=inner, slice=index):
                    if not (chain is not None and chain[0] == SETTINGS and isinstance(index, ast.Constant)):
                        self._visit(index, frames)
                    now = inner
                case ast.Call(func=function):
                    self._call(now, frames, keys)
                    now = function
                case ast.Name():
                    if chain is None:
                        self._found.is_open |= now.id in ("exec", "eval", "vars")
                    return
                case _:
                    self._visit(now, frames)
                    return

    def _call(self, node: ast.Call, frames: tuple[Frame, ...], keys: set[int]) -> None:
        name = next(iter(names_of(node.func)), "")
        is_harmless = name in _HARMLESS or name in self._classes.defined
        if name == "setattr" or name == "__setattr__":
            self._found.is_open |= not any(isinstance(argument, ast.Constant) for argument in node.args[:2])
            is_harmless = True
        for argument in (*node.args, *(word.value for word in node.keywords)):
            if not (is_harmless and isinstance(argument, ast.Name)):
                self._visit(argument, frames)

    def _chain(
        self, node: ast.expr, frames: tuple[Frame, ...], depth: int = 0
    ) -> tuple[str, tuple[Step, ...]] | None:  # fmt: skip
        """Root and steps of an expression, if it is a chain."""
        steps: list[Step] = []
        arguments: Arguments | None = None
        now = node
        while True:
            match now:
                case ast.Attribute(value=inner, attr=name):
                    at = (now.end_col_offset or 0) - len(name.encode())
                    steps.append(Step(self._word(name, now, at, now.end_lineno), arguments))
                    arguments, now = None, inner
                case ast.Subscript(value=inner, slice=index) if arguments is None:
                    steps.append(Step(self._key(index), is_index=True))
                    now = inner
                case ast.Call(func=function) if arguments is None:
                    arguments = self._arguments_of(now)
                    now = function
                case ast.Name(id=name):
                    found = self._lookup(name, frames, depth)
                    if found is None or (arguments is not None and not found[1]):
                        return None
                    root, head = found
                    if arguments is not None:  # a method in a variable: the call is where the variable is
                        here = self._word(name, now, now.col_offset).span
                        head = (*head[:-1], Step(Word(head[-1].word.text, here), arguments, head[-1].is_index))
                    return root, (*head, *reversed(steps))
                case _:
                    return None

    def _arguments_of(self, call: ast.Call) -> Arguments:
        is_exact = not any(isinstance(one, ast.Starred) for one in call.args)
        is_exact = is_exact and all(word.arg is not None for word in call.keywords)
        names = [self._word(word.arg, word, word.col_offset) for word in call.keywords if word.arg is not None]
        first = call.args[0] if call.args else None
        text: Word | None = None
        keys: tuple[Word, ...] = ()
        if isinstance(first, ast.Constant) and isinstance(first.value, str):
            text = self._text_word(first)
        elif isinstance(first, ast.Dict):
            words = (self._text_word(key) for key in first.keys if isinstance(key, ast.Constant))
            keys = tuple(word for word in words if word is not None)
        last = call.args[-1] if call.args else None
        constant = self._constant(last) if last is not None and (text is None or last is not first) else None
        return Arguments(len(call.args), tuple(names), is_exact, text, keys, constant)

    def _key(self, index: ast.expr) -> Word:
        word = self._text_word(index) if isinstance(index, ast.Constant) else None
        return word or Word("", Span(self._path))

    def _text_word(self, node: ast.Constant) -> Word | None:
        """The text in a literal, without its quotes; None if it is not written as it is."""
        if not isinstance(node.value, str) or node.end_lineno != node.lineno:
            return None
        span = self._span(node)
        line = self._lines[node.lineno - 1] if node.lineno <= len(self._lines) else ""
        at = line.find(node.value, span.column - 1, span.end_column - 1)
        if at < 0 or not node.value:
            return None
        return Word(node.value, Span(self._path, node.lineno, at + 1, node.lineno, at + 1 + len(node.value)))

    def _word(self, text: str, node: ast.expr | ast.alias | ast.keyword, byte: int, line: int | None = None) -> Word:
        row = line or node.lineno
        column = self._column(row, byte)
        return Word(text, Span(self._path, row, column, row, column + len(text)))

    def _constant(self, node: ast.expr) -> Constant | None:
        value = constant(node)
        return None if value is None else Constant(value, self._span(node))

    def _span(self, node: ast.expr) -> Span:
        line, end = node.lineno, node.end_lineno or node.lineno
        return Span(
            self._path, line, self._column(line, node.col_offset), end, self._column(end, node.end_col_offset or 0)
        )

    def _column(self, line: int, byte: int) -> int:
        """The column, from 1 and in characters, of a position in bytes."""
        text = self._lines[line - 1] if line <= len(self._lines) else ""
        return byte + 1 if text.isascii() else len(text.encode()[:byte].decode(errors="replace")) + 1

    def _add(self, chain: Chain) -> None:
        self._found.chains.append(chain)


_ELEMENT = Step(Word("", Span("")), is_index=True)


def _literal_head(steps: tuple[Step, ...]) -> tuple[Step, ...]:
    """The leading indices that are literal texts; () if another index follows them, or none leads."""
    head: list[Step] = []
    for step in steps:
        if not step.is_index:
            break
        if not step.word.text:
            return ()
        head.append(step)
    return tuple(head)
