"""Chains of names in Python, with what variables stand for: `self.mouth_proxy.move(pose)`, also through variables that
are bound once."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cached_property

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.usage.code import MODULES, WORKER, Arguments, Chain, Constant, Step, Word
from robocomp_yaml.languages.python.syntax import constant, parameters_of, plain_parameters
from robocomp_yaml.languages.python.usage_forms import form_of
from robocomp_yaml.languages.python.usage_hints import meaning


class Binding(msgspec.Struct, frozen=True):
    """What a variable is bound to: the beginning of a chain, or an expression; `is_element`: an element of it in a
    loop; `places` are the positions in it, from the outer to the inner one. `hint` is its annotation, or the one of its
    result if it `is_function`."""

    root: str = ""
    steps: tuple[Step, ...] = ()
    value: ast.expr | None = None
    is_element: bool = False
    places: tuple[int, ...] = ()
    hint: ast.expr | None = None
    is_function: bool = False


Frame = Mapping[str, Binding | None]
SELF = Binding(WORKER)


class ChainReader:
    """`sources` are the modules from which the Slice modules are imported."""

    def __init__(self, path: str, text: str, sources: Collection[str]) -> None:
        self._path, self._text, self._sources = path, text, sources
        self._rebound: frozenset[str] = frozenset()
        self._is_argument = False
        self._workers: Collection[str] = ()  # the names of the user's workers
        self._returns: Mapping[str, ast.expr] = {}  # the annotations of the results of their methods
        self._again: set[str] = set()  # the parameters that the last scope binds again
        self._aliases: dict[str, tuple[str, tuple[Step, ...]]] = {}  # of attributes of the worker

    @cached_property
    def _lines(self) -> list[str]:
        return re.compile("\r\n|\r|\n").split(self._text)

    def _frame(self, body: Iterable[ast.AST], arguments: ast.arguments | None = None) -> dict[str, Binding | None]:
        """The variables of a scope, with what those are that are bound once."""
        counts: Counter[str] = Counter()
        values: dict[str, Binding] = {}
        given = [argument.arg for argument in parameters_of(arguments)]
        counts.update((*given, *given))
        hints = {one.arg: one.annotation for one in plain_parameters(arguments) if one.annotation is not None}
        bare: Counter[str] = Counter(name for name in hints)  # how often a name is annotated, and gets no value
        todo = list(body)
        while todo:
            node = todo.pop()
            match node:
                case ast.FunctionDef(returns=ast.expr() as returns, decorator_list=[]):
                    counts[node.name] += 1
                    values[node.name] = Binding(hint=returns, is_function=True)
                    continue
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
                case ast.ExceptHandler(name=str(name), type=ast.Attribute() | ast.Name() as value):
                    counts[name] += 1
                    values[name] = Binding(value=ast.Call(value, [], [ast.keyword(None, value)]))  # any arguments
                case ast.ExceptHandler(name=str(name)) | ast.MatchAs(name=str(name)) | ast.MatchStar(name=str(name)):
                    counts[name] += 1
                case ast.Assign(targets=[ast.Name(id=name)], value=value):
                    values[name] = Binding(value=value)
                case ast.AnnAssign(target=ast.Name(id=name), annotation=hint, value=value):
                    hints.setdefault(name, hint)
                    if value is not None:
                        values[name] = Binding(value=value)
                    else:
                        bare[name] += 1
                case ast.NamedExpr(target=ast.Name(id=name), value=value):
                    values[name] = Binding(value=value)
                case ast.Assign(targets=[ast.Tuple() | ast.List() as target], value=value):
                    values |= {name: _placed(value, places) for name, places in _unpacked(target)}
                case ast.For(target=target, iter=value) | ast.comprehension(target=target, iter=value):
                    values |= {
                        name: Binding(value=value, is_element=True, places=places) for name, places in _unpacked(target)
                    }
            todo += ast.iter_child_nodes(node)
        self._again = {name for name in given if counts[name] > 2}
        return {
            name: _bound(values.get(name) if count == 1 else None, hints.get(name) if count <= 1 + bare[name] else None)
            if name not in self._rebound else None
            for name, count in counts.items()
        }  # fmt: skip

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
                if bound is None or name in self._rebound or depth > 8 or bound.is_function:
                    return None
                if bound.value is None and bound.hint is not None:
                    return self._hinted(bound.hint, frames[: index + 1], depth)
                if bound.value is None:
                    return bound.root, bound.steps
                made = self._looped(bound, frames) if bound.is_element else bound
                assert made.value is not None
                bound = made
                chain = self._chain(made.value, frames[: index + 1], depth + 1)
                if chain is None:
                    return self._hinted(bound.hint, frames[: index + 1], depth) if bound.hint is not None else None
                more = (*((_ELEMENT,) if bound.is_element else ()), *map(_place, bound.places))
                return chain[0], (*chain[1], *more)
        return None

    def _of_builtin(
        self, call: ast.Call, frames: tuple[Frame, ...], depth: int
    ) -> tuple[str, tuple[Step, ...]] | None:  # fmt: skip
        """Root and steps of what a function of Python returns: a list with the same elements, or one of them."""
        match call:
            case ast.Call(func=ast.Name(id=name), args=[value]) if name in _ALIKE or name in _ONE_OF:
                if isinstance(value, (ast.Starred, ast.GeneratorExp)) or any(name in one for one in frames):
                    return None
                found = self._chain(value, frames, depth + 1) if depth < 8 else None
                if found is None or not found[1] or any(word.arg == "default" for word in call.keywords):
                    return None
                return found[0], (*found[1], *((_ELEMENT,) if name in _ONE_OF else (_ELEMENT, _MANY)))
        return None

    def _looped(self, bound: Binding, frames: tuple[Frame, ...]) -> Binding:
        """What a variable of a loop is bound to, without `enumerate` and `zip`."""
        match bound:
            case Binding(value=ast.Call(func=ast.Name(id=name), args=[*values], keywords=[*_]), places=(place, *more)):
                if any(name in frame for frame in frames):
                    return bound
                if name == "enumerate" and place == 1 and values:
                    return msgspec.structs.replace(bound, value=values[0], places=tuple(more))
                if name == "zip" and place < len(values) and not isinstance(values[place], ast.Starred):
                    return msgspec.structs.replace(bound, value=values[place], places=tuple(more))
        return bound

    def _same(
        self, nodes: Iterable[ast.expr], frames: tuple[Frame, ...], depth: int
    ) -> tuple[str, tuple[Step, ...]] | None:  # fmt: skip
        """Root and steps that several expressions have in common."""
        found = [self._chain(node, frames, depth + 1) for node in nodes]
        first = found[0] if found else None
        names = {(one[0], tuple(step.word.text for step in one[1])) if one is not None else None for one in found}
        return first if len(names) == 1 else None

    def _hinted(
        self, hint: ast.expr, frames: tuple[Frame, ...], depth: int
    ) -> tuple[str, tuple[Step, ...]] | None:  # fmt: skip
        """Root and steps of what an annotation allows."""
        return meaning(hint, lambda node: self._chain(node, frames, depth + 1), self._workers)

    def _returned_by(
        self, name: str, frames: tuple[Frame, ...], depth: int
    ) -> tuple[str, tuple[Step, ...]] | None:  # fmt: skip
        """Root and steps of what a function returns by its annotation."""
        frame = next((one for one in reversed(frames) if name in one), {})
        bound = frame.get(name)
        if bound is None or not bound.is_function or bound.hint is None or depth > 8:
            return None
        return self._hinted(bound.hint, frames, depth)

    def _chain(
        self, node: ast.expr, frames: tuple[Frame, ...], depth: int = 0
    ) -> tuple[str, tuple[Step, ...]] | None:  # fmt: skip
        """Root and steps of an expression, if it is a chain."""
        steps: list[Step] = []
        arguments: Arguments | None = None
        call: ast.Call | None = None
        now, is_read = node, False
        while True:
            match now:
                case ast.Attribute(value=inner, attr=name):
                    is_read = isinstance(now.ctx, ast.Load)
                    at = (now.end_col_offset or 0) - len(name.encode())
                    steps.append(Step(self._word(name, now, at, now.end_lineno), arguments))
                    arguments, call, now = None, None, inner
                case ast.Subscript(slice=ast.Slice() | ast.Tuple()):
                    return None  # several elements
                case ast.Subscript(value=inner, slice=index) if arguments is None:
                    steps.append(self._index(index))
                    now = inner
                case ast.Call(func=function) if arguments is None:
                    arguments, call = self._arguments_of(now, frames, depth), now
                    now = function
                case ast.NamedExpr(value=inner) if arguments is None:
                    now = inner
                case ast.IfExp(body=body, orelse=orelse) if arguments is None:
                    return _after(self._same(_without_none((body, orelse)), frames, depth), steps)
                case ast.BoolOp(op=ast.Or(), values=values) if arguments is None:
                    return _after(self._same(_without_none(values), frames, depth), steps)
                case ast.Name() if call is not None and (made := self._of_builtin(call, frames, depth)) is not None:
                    return _after(made, steps)
                case ast.Name(id=name):
                    found = self._lookup(name, frames, depth)
                    if found is None and arguments is not None:
                        found, arguments = self._returned_by(name, frames, depth), None
                    if found is None or (arguments is not None and not found[1]):
                        return None
                    root, head = found
                    if found == (WORKER, ()) and steps and steps[-1].word.text in self._returns:
                        if steps[-1].arguments is None:
                            return None
                        made = self._hinted(self._returns[steps[-1].word.text], frames[:1], depth)
                        if made is not None:
                            return made[0], (*made[1], *reversed(steps[:-1]))
                    if found == (WORKER, ()) and steps and is_read and steps[-1].word.text in self._aliases:
                        root, head = self._aliases[steps[-1].word.text]
                        if steps[-1].arguments is not None and not head:
                            return None
                        if (last := steps.pop()).arguments is not None:
                            head = (*head[:-1], Step(Word(head[-1].word.text, last.word.span), last.arguments))
                    if arguments is not None:  # a method in a variable: the call is where the variable is
                        here = self._word(name, now, now.col_offset).span
                        head = (*head[:-1], Step(Word(head[-1].word.text, here), arguments, head[-1].is_index))
                    return root, (*head, *reversed(steps))
                case _:
                    return None

    def _arguments_of(self, call: ast.Call, frames: tuple[Frame, ...], depth: int) -> Arguments:
        is_exact = not any(isinstance(one, ast.Starred) for one in call.args)
        is_exact = is_exact and all(word.arg is not None for word in call.keywords)
        names = [self._word(word.arg, word, word.col_offset) for word in call.keywords if word.arg is not None]
        first = call.args[0] if call.args else None
        text: Word | None = None
        under: dict[Word, Constant | None] = {}
        if isinstance(first, ast.Constant) and isinstance(first.value, str):
            text = self._text_word(first)
        elif isinstance(first, ast.Dict):
            for key, value in zip(first.keys, first.values, strict=True):
                word = self._text_word(key) if isinstance(key, ast.Constant) else None
                under |= {} if word is None else {word: self._constant(value)}
        last = call.args[-1] if call.args else None
        constant = self._constant(last) if last is not None and (text is None or last is not first) else None
        values = tuple(map(self._constant, call.args))
        named = tuple(self._constant(word.value) for word in call.keywords if word.arg is not None)
        forms: tuple[Word | None, ...] = ()
        chains: tuple[Chain | None, ...] = ()
        if not self._is_argument:  # what the arguments of arguments are is never used
            self._is_argument = True
            forms = tuple(self._form(node, frames) for node in call.args)
            chains = tuple(self._as_chain(node, frames, depth + 1) for node in call.args)
            self._is_argument = False
        inside = tuple(map(self._inside, call.args))
        return Arguments(
            len(call.args), tuple(names), is_exact, text, tuple(under), constant, values, named, forms, chains, inside,
            tuple(under.values()),
        )  # fmt: skip

    def _inside(self, node: ast.expr) -> tuple[Constant, ...]:
        """The literals in a literal list or tuple."""
        elements = node.elts if isinstance(node, (ast.List, ast.Tuple)) else []
        return tuple(found for found in map(self._constant, elements) if found is not None)

    def _form(self, node: ast.expr, frames: tuple[Frame, ...]) -> Word | None:
        def bound(name: str) -> ast.expr | None:
            found = next((frame[name] for frame in reversed(frames) if name in frame), None)
            is_value = found is not None and not found.is_element and not found.places and name not in self._rebound
            return found.value if found is not None and is_value else None

        form = form_of(node, bound, lambda name: not any(name in frame for frame in frames))
        return Word(form, self._span(node)) if form else None

    def _as_chain(self, node: ast.expr, frames: tuple[Frame, ...], depth: int) -> Chain | None:
        found = self._chain(node, frames, depth)
        if found is None or not found[1]:
            return None
        last = msgspec.structs.replace(found[1][-1], word=Word(found[1][-1].word.text, self._span(node)))
        return Chain(found[0], (*found[1][:-1], last))

    def _index(self, index: ast.expr) -> Step:
        word = self._text_word(index) if isinstance(index, ast.Constant) else None
        span = self._span(index)
        line = self._lines[span.line - 1] if span.line == span.end_line else ""
        shown = Word(line[span.column - 1 : span.end_column - 1], span) if line else None
        value = constant(index)
        place = value if isinstance(value, int) and not isinstance(value, bool) else None
        return Step(word or Word("", Span(self._path)), is_index=True, shown=shown, place=place)

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


def _bound(binding: Binding | None, hint: ast.expr | None) -> Binding | None:
    """What a variable is bound to by its only value, or by its annotation."""
    if hint is None:
        return binding
    return Binding(hint=hint) if binding is None else msgspec.structs.replace(binding, hint=hint)


def _unpacked(target: ast.expr) -> Iterator[tuple[str, tuple[int, ...]]]:
    """The variables to which a value is unpacked, each with its positions in it."""
    match target:
        case ast.Name(id=name):
            yield name, ()
        case ast.Tuple(elts=elements) | ast.List(elts=elements):
            if not any(isinstance(one, ast.Starred) for one in elements):
                for number, one in enumerate(elements):
                    for name, places in _unpacked(one):
                        yield name, (number, *places)


def _placed(value: ast.expr, places: tuple[int, ...]) -> Binding:
    """The value at a position of another one."""
    while places and isinstance(value, (ast.Tuple, ast.List)):
        if any(isinstance(one, ast.Starred) for one in value.elts) or places[0] >= len(value.elts):
            break
        value, places = value.elts[places[0]], places[1:]
    return Binding(value=value, places=places)


def _without_none(nodes: Iterable[ast.expr]) -> list[ast.expr]:
    return [node for node in nodes if not (isinstance(node, ast.Constant) and node.value is None)]


def _after(
    found: tuple[str, tuple[Step, ...]] | None, steps: list[Step]
) -> tuple[str, tuple[Step, ...]] | None:  # fmt: skip
    return (found[0], (*found[1], *reversed(steps))) if found is not None and found[1] else None


def _place(number: int) -> Step:
    return Step(Word("", Span("")), is_index=True, place=number)


_ALIKE = frozenset("iter list reversed set sorted tuple".split())
_ONE_OF = frozenset("max min next".split())
"""Functions of Python that return a list of the same elements, or one of them."""
_MANY = Step(Word("", Span("")), makes="list")
_ELEMENT = Step(Word("", Span("")), is_index=True, is_each=True)
