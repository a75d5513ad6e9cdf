"""What annotations say that a value is: a proxy, a struct, a list of them, or a worker."""

from __future__ import annotations

import ast
from collections.abc import Callable, Collection, Iterator

from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.usage.code import MODULES, WORKER, Step, Word
from robocomp_yaml.languages.python.syntax import names_of

Found = tuple[str, tuple[Step, ...]]
_GENERIC = "GenericWorker"
_THE_SAME = frozenset("Annotated ClassVar Final Optional Required".split())
_LISTS = frozenset("Collection Deque Iterable Iterator List MutableSequence Sequence deque list".split())
_MAPS = frozenset("Dict Mapping MutableMapping dict".split())
_NO_WORD = Word("", Span(""))
_LIST, _MAP = Step(_NO_WORD, makes="list"), Step(_NO_WORD, makes="map")


def meaning(
    node: ast.expr | None, resolve: Callable[[ast.expr], Found | None], workers: Collection[str]
) -> Found | None:
    """Root and steps of what an annotation allows, apart from None; None if it is unknown, or one of several. `resolve`
    has root and steps of a name, and `workers` are the names of the user's workers."""
    match node:
        case ast.Constant(value=str(text)):
            return meaning(_quoted(node, text), resolve, workers)
        case ast.BinOp(op=ast.BitOr()):
            every = [one for one in _alternatives(node) if not _is_none(one)]
            return meaning(every[0], resolve, workers) if len(every) == 1 else None
        case ast.Subscript(value=outer, slice=inner):
            name = next(iter(names_of(outer)), "")
            elements = inner.elts if isinstance(inner, ast.Tuple) else [inner]
            if name in _THE_SAME and (len(elements) == 1 or name == "Annotated"):
                return meaning(elements[0], resolve, workers)
            if name == "Union":
                every = [one for one in elements if not _is_none(one)]
                return meaning(every[0], resolve, workers) if len(every) == 1 else None
            if name in _LISTS and len(elements) == 1:
                return _more(meaning(elements[0], resolve, workers), _LIST)
            if name == "tuple" and len(elements) == 2 and _is_ellipsis(elements[1]):
                return _more(meaning(elements[0], resolve, workers), _LIST)
            if name in _MAPS and len(elements) == 2:
                return _more(meaning(elements[1], resolve, workers), _MAP)
            return None
        case ast.Name(id=name) if name in workers or name == _GENERIC:
            return WORKER, ()
        case ast.Name() | ast.Attribute():
            found = resolve(node)
            if found is None or found[0] != MODULES or not found[1] or any(step.is_index for step in found[1]):
                return None
            if any(step.arguments is not None or step.is_instance for step in found[1]):
                return None
            return MODULES, tuple(Step(step.word, is_instance=True) for step in found[1])
        case _:
            return None


def _more(found: Found | None, step: Step) -> Found | None:
    return (found[0], (*found[1], step)) if found is not None and found[1] else None


def _quoted(node: ast.Constant, text: str) -> ast.expr | None:
    """The expression in a literal text."""
    try:
        made = ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError):
        return None
    for inner in ast.walk(made):  # its words are reported where the text is
        if isinstance(inner, ast.expr):
            inner.lineno, inner.end_lineno = node.lineno, node.end_lineno
            inner.col_offset, inner.end_col_offset = node.col_offset, node.end_col_offset
    return made


def _alternatives(node: ast.expr) -> Iterator[ast.expr]:
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.BitOr):
        yield from _alternatives(node.left)
        yield from _alternatives(node.right)
    else:
        yield node


def _is_none(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value is None


def _is_ellipsis(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value is Ellipsis
