"""The use that one file of Python makes of the worker: chains of names, comparisons, and what it stores."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Container, Iterable

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.digraph import preorder
from robocomp_yaml.emit.usage.code import (
    CONDITION,
    FILE,
    LOOPED,
    MODULES,
    SERVED,
    SETTINGS,
    WORKER,
    Chain,
    Constant,
    Returned,
    Step,
    Word,
    literal_head,
)
from robocomp_yaml.languages.python.syntax import (
    all_names,
    annotations_of,
    imports_all,
    names_of,
    unpacked_count,
)
from robocomp_yaml.languages.python.usage_chains import SELF, Binding, ChainReader, Frame
from robocomp_yaml.languages.python.usage_classes import UserClasses
from robocomp_yaml.languages.python.usage_signatures import results

_Function = (ast.FunctionDef, ast.AsyncFunctionDef)
# A worker that these get is not changed.
_HARMLESS = frozenset("bool callable getattr hasattr id isinstance print repr str super type QTimer QThread".split())


class FileUsage(msgspec.Struct):
    chains: list[Chain] = []
    methods: list[Word] = []
    stored: set[str] = set()
    texts: set[str] = set()
    is_open: bool = False
    is_shared: bool = False
    returned: list[Returned] = []


class UsageReader(ChainReader):
    def __init__(
        self,
        path: str,
        text: str,
        classes: UserClasses,
        modules: frozenset[str],
        served: Container[str],
        answers: Container[str],
        stored: Counter[str],
        signatures: Container[str],
        functions: Container[str],
        is_robocomp: bool,
    ) -> None:
        super().__init__(path, text, {"generated.interfaces", *(("interfaces",) if is_robocomp else ())})
        self._classes, self._stored, self._workers = classes, stored, classes.workers
        self._signatures, self._functions = signatures, functions
        self._modules, self._served, self._answers, self._is_robocomp = modules, served, answers, is_robocomp
        self._found = FileUsage()
        self._caught: frozenset[str] = frozenset()
        self._is_lazy = False  # annotations are not evaluated
        self._is_hint = False
        self._answering = ""  # the method of an interface around the present statement

    def read(self, tree: ast.Module) -> FileUsage:
        if "global " in self._text or "nonlocal " in self._text:
            scopes = (node for node in ast.walk(tree) if isinstance(node, (ast.Global, ast.Nonlocal)))
            self._rebound = frozenset(name for node in scopes for name in node.names)
        self._is_lazy = any(
            isinstance(node, ast.ImportFrom)
            and node.module == "__future__"
            and any(alias.name == "annotations" for alias in node.names)
            for node in tree.body
        )
        frame = self._frame(tree.body)
        if any(imports_all(node, {*self._sources, "genericworker"}) for node in tree.body):
            known = {name: Binding(MODULES, (Step(Word(name, Span(self._path))),)) for name in self._modules}
            frame = {**known, **frame}
        self._returns = {
            name: one for name, one in results(tree).items() if name in self._signatures and not self._stored[name]
        }
        self._find_aliases(tree, frame)
        self._visit_all(tree.body, (frame,))
        return self._found

    def _find_aliases(self, tree: ast.Module, frame: Frame) -> None:
        """The attributes of the worker that are another name of something: `self.mouth = self.mouth_proxy`."""
        for class_ in tree.body:
            if not isinstance(class_, ast.ClassDef) or class_.name not in self._classes.workers:
                continue
            for method in class_.body:
                if isinstance(method, ast.AnnAssign) and isinstance(method.target, ast.Name):
                    self._hint_alias(method.target.id, method.annotation, frame)
                for node in ast.walk(method) if isinstance(method, _Function) else ():
                    match node:
                        case (
                            ast.Assign(targets=[ast.Attribute(value=ast.Name(id=owner), attr=name)], value=value)
                            | ast.AnnAssign(
                                target=ast.Attribute(value=ast.Name(id=owner), attr=name), value=ast.expr() as value
                            )
                        ) if self._stored[name] == 1 and isinstance(method, _Function):
                            frames = (frame, self._method_frame(method))
                            if self._lookup(owner, frames) == (WORKER, ()):
                                chain = self._chain(value, frames)
                                if (chain is not None and chain[1]) or chain == (SETTINGS, ()):
                                    self._aliases[name] = chain
                    match node:
                        case ast.AnnAssign(target=ast.Attribute(value=ast.Name(id=owner), attr=name), annotation=hint):
                            if isinstance(method, _Function):
                                if self._lookup(owner, (frame, self._method_frame(method))) == (WORKER, ()):
                                    self._hint_alias(name, hint, frame)

    def _hint_alias(self, name: str, hint: ast.expr, frame: Frame) -> None:
        """An attribute of the worker with an annotation."""
        found = self._hinted(hint, (frame,), 0)
        if found is not None and found[1] and name not in self._aliases:
            self._aliases[name] = found

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
            case ast.Return(value=ast.expr() as value):
                if self._answering:
                    self._returned(value, frames)
                self._visit(value, frames)
            case ast.FunctionDef() | ast.AsyncFunctionDef():
                self._function(node, frames)
            case ast.Lambda():
                self._visit(node.body, (*frames, self._frame([node.body], node.args)))
            case ast.ClassDef():
                self._class(node, frames)
            case ast.Assign(targets=targets, value=value):
                for target in targets:
                    self._target(target, value, frames)
                self._visit_value(value, frames, unpacked_count(targets))
            case ast.AnnAssign(target=target, annotation=annotation, value=ast.expr() as value):
                self._visit_hints([annotation], frames)
                self._target(target, value, frames)
                self._visit_value(value, frames)
            case ast.AnnAssign(target=target, annotation=annotation):
                self._visit(target, frames)
                self._visit_hints([annotation], frames)
            case ast.Compare(left=left, ops=[ast.Eq() | ast.NotEq() | ast.In() | ast.NotIn()], comparators=[right]):
                self._compared(left, right, frames)
            case ast.BinOp(left=left, op=ast.Add(), right=right):
                for one, other in ((left, right), (right, left)):
                    form, chain = self._form(other, frames), self._chain(one, frames)
                    if form is not None and chain is not None and chain[1]:
                        self._add_again(Chain(*chain, caught=self._caught, added=form))
                self._visit_all((left, right), frames)
            case ast.If(test=test) | ast.While(test=test) | ast.IfExp(test=test) | ast.Assert(test=test) if isinstance(
                test, (ast.Call, ast.UnaryOp)
            ):
                self._used(test.operand if isinstance(test, ast.UnaryOp) else test, CONDITION, frames)
                self._visit_all(ast.iter_child_nodes(node), frames)
            case ast.For(iter=ast.Call() as value) | ast.comprehension(iter=ast.Call() as value):
                self._used(value, LOOPED, frames)
                self._visit_all(ast.iter_child_nodes(node), frames)
            case ast.Match(subject=subject, cases=cases):
                self._compared(subject, _patterns(cases), frames)
                self._visit_all(cases, frames)
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

    def _visit_hints(self, nodes: Iterable[ast.expr], frames: tuple[Frame, ...]) -> None:
        self._is_hint = self._is_lazy
        self._visit_all(nodes, frames)
        self._is_hint = False

    def _compared(self, left: ast.expr, right: ast.expr, frames: tuple[Frame, ...]) -> None:
        """A comparison of a chain with literals, on one of its sides or in a list."""
        for one, other in ((left, right), (right, left)):
            elements = other.elts if isinstance(other, (ast.Tuple, ast.List, ast.Set)) else [other]
            found = tuple(made for made in map(self._constant, elements) if made is not None)
            chain = self._chain(one, frames) if found else None
            if chain is not None and chain[1]:
                self._add_again(Chain(*chain, caught=self._caught, compared=found))
        self._visit_all((left, right), frames)

    def _used(self, node: ast.expr, used: str, frames: tuple[Frame, ...]) -> None:
        """The result of a call that is used at once."""
        chain = self._chain(node, frames) if isinstance(node, ast.Call) else None
        if chain is not None and chain[1]:
            self._add_again(Chain(*chain, caught=self._caught, used=used))

    def _add_again(self, chain: Chain) -> None:
        """Adds a chain whose steps belong to another one, too."""
        steps = literal_head(chain.steps) if chain.root == SETTINGS else chain.steps
        if steps and len(steps) == len(chain.steps):
            self._add(msgspec.structs.replace(chain, steps=steps, is_again=True))

    def _probed(self) -> frozenset[str]:
        """An import that may fail is one that tries whether something exists."""
        return frozenset(("AttributeError",)) if "ImportError" in self._caught else frozenset()

    def _visit_value(self, value: ast.expr, frames: tuple[Frame, ...], unpacked: int = 0) -> None:
        """An assigned value. Another name of the worker is followed, unless it is an attribute of something."""
        if isinstance(value, ast.Call) and unpacked:
            self._expression(value, frames, unpacked=unpacked)
        elif not isinstance(value, ast.Name):
            self._visit(value, frames)

    def _guarded(self, body: list[ast.stmt], names: set[str], frames: tuple[Frame, ...]) -> None:
        before, self._caught = self._caught, self._caught | names
        self._visit_all(body, frames)
        self._caught = before

    def _function(self, node: ast.FunctionDef | ast.AsyncFunctionDef, frames: tuple[Frame, ...]) -> None:
        self._visit_all((*node.decorator_list, *node.args.defaults, *filter(None, node.args.kw_defaults)), frames)
        self._visit_hints(annotations_of(node), frames)
        frame = self._frame(node.body, node.args)
        around, self._answering = self._answering, ""
        self._visit_all(node.body, (*frames, frame))
        self._answering = around

    def _returned(self, value: ast.expr, frames: tuple[Frame, ...]) -> None:
        """What a method of an interface returns; each of two alternatives by itself."""
        if isinstance(value, ast.IfExp):
            self._returned(value.body, frames)
            self._returned(value.orelse, frames)
            return
        is_tuple = isinstance(value, ast.Tuple)
        call = ast.Call(value, value.elts if isinstance(value, ast.Tuple) else [value], [])
        made = Returned(self._answering, self._span(value), self._arguments_of(call, frames, 0), is_tuple)
        self._found.returned.append(made)

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
        self._visit_all((*node.decorator_list, *node.args.defaults), frames)
        self._visit_hints(annotations_of(node), frames)
        is_plain = not node.decorator_list and isinstance(node, ast.FunctionDef)
        self._answering = node.name if is_plain and node.name in self._answers else ""
        self._visit_all(node.body, (*frames, self._method_frame(node)))
        self._answering = ""

    def _method_frame(self, node: ast.FunctionDef | ast.AsyncFunctionDef) -> dict[str, Binding | None]:
        """The variables of a method of the worker."""
        frame = self._frame(node.body, node.args)
        again = self._again
        first = next(iter([*node.args.posonlyargs, *node.args.args]), None)
        decorators = {name for one in node.decorator_list for name in names_of(one)}
        if first is not None and not decorators & {"staticmethod", "classmethod"} and first.arg not in again:
            frame[first.arg] = SELF
        if node.name in self._served:
            for number, argument in enumerate(node.args.args[1:]):
                if argument.arg not in again:
                    steps = (Step(Word(node.name, Span(self._path))), Step(Word(str(number), Span(self._path))))
                    frame[argument.arg] = Binding(SERVED, steps)
        if self._is_robocomp:
            for argument in node.args.args[1:]:
                is_params = node.name == "setParams" or argument.arg == "configData"
                if is_params and argument.arg not in again:
                    frame[argument.arg] = Binding(SETTINGS)
        return frame

    def _target(self, target: ast.expr, value: ast.expr, frames: tuple[Frame, ...]) -> None:
        if isinstance(target, (ast.Attribute, ast.Subscript)):
            self._expression(target, frames, self._constant(value))
        else:
            self._visit_all(ast.iter_child_nodes(target), frames)
            if isinstance(value, ast.Name) and not isinstance(target, ast.Name):
                self._visit(value, frames)

    def _expression(
        self, node: ast.expr, frames: tuple[Frame, ...], value: Constant | None = None, unpacked: int = 0
    ) -> None:  # fmt: skip
        """Records the chain that ends here, and visits what is in it: arguments, indices, and its beginning."""
        chain = self._chain(node, frames)
        is_assigned = isinstance(getattr(node, "ctx", None), (ast.Store, ast.Del))
        keys: set[int] = set()
        if chain is not None and chain[0] == SETTINGS:
            steps = literal_head(chain[1])
            if steps and not is_assigned:
                self._add(Chain(SETTINGS, steps, caught=self._caught))
        elif chain is not None and chain[1]:
            made = Chain(*chain, is_assigned=is_assigned, constant=value, caught=self._caught, unpacked=unpacked)
            self._add(made)
        now: ast.expr = node
        while True:
            match now:
                case ast.Attribute(value=inner):
                    steps = chain[1] if chain is not None else ()
                    is_inside = len(steps) > 1 and steps[0].word.text == "parameters"
                    if isinstance(now.ctx, (ast.Store, ast.Del)) and not is_inside:
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

    def _own_call(self, node: ast.Call, frames: tuple[Frame, ...]) -> None:
        """Records a call of what the code defines itself."""
        match node.func:
            case ast.Attribute(value=ast.Name(id=owner), attr=name) if name in self._signatures:
                if self._lookup(owner, frames) == (WORKER, ()):
                    word = self._word(name, node.func, (node.func.end_col_offset or 0) - len(name.encode()))
                    self._add(Chain(WORKER, (Step(word, self._arguments_of(node, frames, 0)),), caught=self._caught))
            case ast.Name(id=name) if name in self._functions and not any(name in one for one in frames[1:]):
                word = self._word(name, node.func, node.func.col_offset)
                self._add(Chain(FILE, (Step(word, self._arguments_of(node, frames, 0)),), caught=self._caught))

    def _call(self, node: ast.Call, frames: tuple[Frame, ...], keys: set[int]) -> None:
        self._own_call(node, frames)
        name = next(iter(names_of(node.func)), "")
        is_harmless = name in _HARMLESS or name in self._classes.defined
        if name == "setattr" or name == "__setattr__":
            self._found.is_open |= not any(isinstance(argument, ast.Constant) for argument in node.args[:2])
            is_harmless = True
        for argument in (*node.args, *(word.value for word in node.keywords)):
            if not (is_harmless and isinstance(argument, ast.Name)):
                self._visit(argument, frames)

    def _add(self, chain: Chain) -> None:
        self._found.chains.append(msgspec.structs.replace(chain, is_hint=True) if self._is_hint else chain)


def _patterns(cases: list[ast.match_case]) -> ast.Tuple:
    """The literals of the cases of a match statement."""

    def inner(pattern: ast.pattern) -> Iterable[ast.pattern]:
        if isinstance(pattern, ast.MatchAs):
            return [pattern.pattern] if pattern.pattern is not None else []
        return pattern.patterns if isinstance(pattern, ast.MatchOr) else []

    every = preorder([case.pattern for case in cases], inner)
    return ast.Tuple([one.value for one in every if isinstance(one, ast.MatchValue)], ast.Load())
