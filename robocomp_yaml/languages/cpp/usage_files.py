"""Where one file of C++ uses a name of the worker: `mouth_proxy->move(pose)`, `this->parameters.speed()`."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

import msgspec
from tree_sitter import Node

from robocomp_yaml.digraph import preorder
from robocomp_yaml.emit.specific.code import around, field, text
from robocomp_yaml.emit.usage.code import MODULES, WORKER, Arguments, Chain, Constant, Step, Word
from robocomp_yaml.emit.usage.judge import is_proxy
from robocomp_yaml.languages._shared.usage_file import UsageFile
from robocomp_yaml.languages.cpp.code import parse

# Where an identifier is used. Everywhere else, it is declared.
_USES = frozenset(
    """argument_list assignment_expression binary_expression call_expression case_statement cast_expression
    comma_expression compound_literal_expression condition_clause conditional_expression co_await_expression
    delete_expression expression_statement field_expression for_range_loop for_statement if_statement
    initializer_list initializer_pair lambda_capture_specifier new_declarator parenthesized_expression
    pointer_expression qualified_identifier return_statement sizeof_expression subscript_argument_list
    subscript_expression switch_statement throw_statement unary_expression update_expression while_statement
    field_initializer co_return_statement co_yield_statement decltype""".split()
)
_TEXTS = ("comment", "preproc_arg", "raw_string_content", "string_content", "string_literal", "system_lib_string")
_INITIALIZERS = ("init_declarator", "optional_parameter_declaration", "lambda_capture_initializer", "declaration")
_MACRO = re.compile(r"[A-Z][A-Z0-9_]+\Z")


class Occurrence(msgspec.Struct, frozen=True):
    """A name in the code: declared there, or used in a chain, or neither, if it has another meaning or is not sure."""

    is_declared: bool = False
    chain: Chain | None = None


_OTHER, _DECLARED = Occurrence(), Occurrence(is_declared=True)


class CppFile(UsageFile):
    def __init__(self, path: str, source: str) -> None:
        super().__init__(path, source, parse)

    def classes(self) -> Iterator[tuple[str, list[str]]]:
        """The classes with their bases."""
        if b"class" not in self._bytes and b"struct" not in self._bytes:
            return
        for node in of_types(self._tree.root_node, ("class_specifier", "struct_specifier"), _IN_SCOPES):
            if node.child_by_field_name("body") is not None:
                clause = next((child for child in node.children if child.type == "base_class_clause"), None)
                bases = [one for one in clause.named_children if one.type != "access_specifier"] if clause else []
                yield text(field(node, "name")), [text(base).rpartition("::")[2] for base in bases]

    def methods(self, workers: Collection[str]) -> Iterator[Word]:
        """The names of the methods that the worker's classes declare and define."""
        for node in of_types(self._tree.root_node, ("function_declarator",), IN_CLASSES):
            name = node.child_by_field_name("declarator")
            if name is None:
                continue
            if name.type == "qualified_identifier" and text(field(name, "scope")) in workers:
                name = field(name, "name")
            elif name.type != "field_identifier" or class_around(node) not in workers:
                continue
            if name.type in ("identifier", "field_identifier"):
                yield self._word(name)

    def occurrences(self, name: str, workers: Collection[str]) -> Iterator[Occurrence]:
        """All occurrences of a name, also through variables that it initializes."""
        for node in self._nodes(name, 0, len(self._bytes)):
            start = self._start(node, name, workers)
            if isinstance(start, Occurrence):
                yield start
                continue
            steps, end = self._steps([Step(self._word(node))], start)
            yield Occurrence(chain=Chain(WORKER, tuple(steps)))
            more = (*self._through_variable(WORKER, steps, end), *self._changed(steps, end))
            for chain in (*self._compared(WORKER, steps, end), *more):
                yield Occurrence(chain=chain)

    def _changed(self, steps: list[Step], end: Node) -> Iterator[Chain]:
        """The chains in the function that changes the parameters: `parameters.change([](auto& values) { … })`."""
        given = end.child_by_field_name("arguments") if end.type == "call_expression" else None
        called = given.named_children[0] if given is not None and given.named_children else None
        if [step.word.text for step in steps] != ["parameters", "change"] or called is None:
            return
        body, declared = called.child_by_field_name("body"), called.child_by_field_name("declarator")
        found = re.fullmatch(r"\(\s*(?:auto|[\w:]*\bValues)\s*&\s*(\w+)\s*\)", text(declared) if declared else "")
        if called.type != "lambda_expression" or body is None or found is None:
            return
        uses = [one for one in self._nodes(found[1], body.start_byte, body.end_byte) if one.type == "identifier"]
        if all(one.parent is not None and _is_used(one, one.parent) for one in uses):
            head = [steps[0], Step(Word("now", steps[1].word.span), Arguments(is_exact=False))]
            for node in uses:
                longer, _ = self._steps(head, node, is_value=True)
                if len(longer) > len(head) and not is_uncertain(node):
                    yield Chain(WORKER, tuple(longer))

    def qualified(self, module: str) -> Iterator[Chain]:
        """The names in a Slice module: `RoboCompMouth::Shape::round`."""
        if module.encode() not in self._bytes:
            return
        for node in self._nodes(module, 0, len(self._bytes)):
            parent = node.parent
            is_scope = (
                parent is not None and parent.type == "qualified_identifier" and node.type == "namespace_identifier"
            )
            if not is_scope or parent is None or parent.child_by_field_name("scope") != node or is_uncertain(node):
                continue
            if parent.parent is not None and parent.parent.type == "qualified_identifier":
                if parent.parent.child_by_field_name("scope") != parent and _has_scope(parent.parent):
                    continue  # the module of another namespace
            steps, now = [Step(self._word(node))], parent.child_by_field_name("name")
            while now is not None and now.type == "qualified_identifier":
                if (scope := now.child_by_field_name("scope")) is None or "identifier" not in scope.type:
                    break
                steps.append(Step(self._word(scope)))
                now = now.child_by_field_name("name")
            if now is not None and now.type in ("identifier", "type_identifier"):
                steps.append(Step(self._word(now)))
            yield Chain(MODULES, tuple(steps))

    def _nodes(self, name: str, start: int, end: int) -> Iterator[Node]:
        """The nodes between two positions in bytes that are this word, except in comments and texts."""
        return (node for node in self._found(name, start, end) if node.type not in _TEXTS)

    def _start(self, node: Node, name: str, workers: Collection[str]) -> Node | Occurrence:
        """The node at which a chain begins, if the word is a use of the worker."""
        parent = node.parent
        if parent is not None and parent.type == "qualified_identifier" and node.type == "namespace_identifier":
            return _OTHER  # the namespace of something, such as `parameters::Values`
        if parent is None or text(node) != name or node.type not in ("identifier", "field_identifier"):
            return _DECLARED
        start = node
        if parent.type == "field_expression" and node.type == "field_identifier":
            owner = parent.child_by_field_name("argument")
            if owner is None or owner.type != "this":
                return _OTHER  # that of another object
            start = parent
        elif node.type == "field_identifier" or not _is_used(node, parent):
            return _DECLARED
        if is_uncertain(start) or worker_around(start) not in workers:
            return _OTHER
        return start

    def _steps(self, head: list[Step], start: Node, *, is_value: bool = False) -> tuple[list[Step], Node]:
        """The steps of a chain that begins with some at a node, and the node at which it ends."""
        steps, now = list(head), start
        while (parent := now.parent) is not None:
            if is_dereferenced(parent) and _is_pointer(steps) and not is_value:
                is_value = True  # a dot follows
            elif (get := _of_get(parent, now)) is not None and _is_pointer(steps) and not is_value:
                parent = get
            elif parent.type == "field_expression" and parent.child_by_field_name("argument") == now:
                name = parent.child_by_field_name("field")
                operator = text(field(parent, "operator"))
                if name is None or name.type != "field_identifier" or not _is_followed(steps, operator, is_value):
                    break
                steps.append(Step(self._word(name)))
            elif parent.type == "call_expression" and parent.child_by_field_name("function") == now:
                if steps[-1].is_index or steps[-1].arguments is not None:
                    break
                steps[-1] = msgspec.structs.replace(steps[-1], arguments=self._arguments(parent))
            elif parent.type == "subscript_expression" and parent.child_by_field_name("argument") == now:
                steps.append(self._index(self._key(parent)))
            elif parent.type != "parenthesized_expression":
                break
            now = parent
        return steps, now

    def _compared(self, root: str, steps: list[Step], end: Node) -> Iterator[Chain]:
        """A comparison of a chain with a literal."""
        parent = end.parent
        if parent is None or parent.type != "binary_expression" or text(field(parent, "operator")) not in ("==", "!="):
            return
        sides = (field(parent, "left"), field(parent, "right"))
        constant = self._literal(sides[0] if sides[1] == end else sides[1])
        if constant is not None and not is_uncertain(end):
            yield Chain(root, tuple(steps), compared=(constant,), is_again=True)

    def _through_variable(self, root: str, steps: list[Step], end: Node) -> Iterator[Chain]:
        """The chains that begin at a local variable, if a chain initializes it, and no other of its name is near."""
        parent = end.parent
        if parent is not None and parent.type == "lambda_capture_initializer" and field(parent, "right") == end:
            yield from self._of_variable(root, steps, field(parent, "left"), parent)
            return
        if parent is not None and parent.type in ("initializer_list", "argument_list") and len(parent.children) == 3:
            end, parent = parent, parent.parent  # `auto mouth{mouth_proxy}`
            if parent is None or any(text(child) == "=" for child in parent.children):
                return
        if parent is not None and parent.type == "init_declarator" and parent.child_by_field_name("value") == end:
            declaration = parent.parent
        elif parent is not None and parent.type == "for_range_loop" and parent.child_by_field_name("right") == end:
            declaration, steps = parent, [*steps, self._index(is_each=True)]
        else:
            return
        type_ = field(declaration, "type") if declaration is not None else None
        if declaration is None or type_ is None or declaration.type not in ("declaration", "for_range_loop"):
            return
        is_same = type_.type == "placeholder_type_specifier" or text(type_).endswith(("PrxPtr", "Prx>"))
        declarator = parent.child_by_field_name("declarator")
        while declarator is not None and declarator.type == "reference_declarator":
            declarator = declarator.named_children[-1]
        if declarator is not None and declarator.type == "identifier":
            is_value = root == MODULES or is_dereferenced(end)
            yield from self._of_variable(root, steps, declarator, declaration, is_same=is_same, is_value=is_value)

    def _of_variable(
        self, root: str, steps: list[Step], name: Node, declaration: Node, *, is_same: bool = True,
        is_value: bool | None = None,
    ) -> Iterator[Chain]:  # fmt: skip
        """The chains of a variable that stands for some steps; only comparisons unless it `is_same`, because its type
        is another one."""
        function = function_around(declaration)
        if function is None:
            return
        uses = []
        for node in self._nodes(text(name), function.start_byte, function.end_byte):
            if node.type == "identifier" and node != name:
                if node.parent is None or not _is_used(node, node.parent):
                    return
                uses.append(node)
        is_value = root == MODULES if is_value is None else is_value
        for node in uses:
            longer, end = self._steps(steps, node, is_value=is_value)
            if is_same and len(longer) > len(steps) and not is_uncertain(node):
                yield Chain(root, tuple(longer))
            yield from self._compared(root, longer, end)
            if is_same and node.start_byte > name.start_byte and not is_uncertain(node):
                yield from self._through_variable(root, longer, end)

    def _arguments(self, call: Node) -> Arguments:
        given = call.child_by_field_name("arguments")
        if given is None or given.type != "argument_list":
            return Arguments(is_exact=False)
        nodes = [node for node in given.named_children if node.type != "comment"]
        is_exact = not given.has_error and not any(
            node.type == "parameter_pack_expansion" or _MACRO.match(text(_called(node))) for node in nodes
        )
        return self._arguments_of(nodes, is_exact)

    def _key(self, index: Node) -> Constant | None:
        """The literal of an index."""
        given = index.child_by_field_name("indices")
        return self._literal(given.named_children[0]) if given is not None and given.named_children else None

    def _value_of(self, node: Node) -> str | int | float | None:
        written = text(node)
        value: str | int | float | None = None
        if node.type == "number_literal" or (node.type == "unary_expression" and re.match(r"-\s*[\d.]", written)):
            number = re.fullmatch(r"(-?)\s*(\d+|\d*\.\d+|\d+\.\d*)([fFlL]*)", written)
            if number:
                is_whole = number[2].isdigit() and "f" not in number[3].lower()
                value = (int if is_whole else float)(number[1] + number[2])
                if number[2].startswith("0") and number[2].isdigit() and number[2] != "0":
                    return None  # octal
        elif node.type in ("true", "false"):
            value = node.type == "true"
        elif node.type == "string_literal" and "\\" not in written and written[:1] == '"':
            value = written[1:-1]
        return value


def is_dereferenced(node: Node) -> bool:
    """Whether a node is `*x`."""
    return node.type == "pointer_expression" and text(field(node, "operator")) == "*"


def _is_pointer(steps: list[Step]) -> bool:
    """Whether some steps lead to a proxy, which is a shared pointer."""
    return len(steps) == 1 and is_proxy(steps[0].word.text)


def _of_get(parent: Node, now: Node) -> Node | None:
    """The call `x.get()` of the pointer in a shared one, if it is above these nodes."""
    if parent.type != "field_expression" or parent.child_by_field_name("argument") != now:
        return None
    call = parent.parent
    is_get = text(field(parent, "operator")) == "." and text(field(parent, "field")) == "get"
    is_call = call is not None and call.type == "call_expression" and call.child_by_field_name("function") == parent
    return call if is_get and is_call else None


def _is_used(node: Node, parent: Node) -> bool:
    if parent.type in _INITIALIZERS:
        value = parent.child_by_field_name("value") or parent.child_by_field_name("default_value")
        if parent.type == "lambda_capture_initializer":
            value = parent.child_by_field_name("right")
        return value == node
    if parent.type == "for_range_loop":
        return parent.child_by_field_name("right") == node
    if parent.type == "qualified_identifier":
        return False
    return parent.type in _USES


def _is_followed(steps: list[Step], operator: str, is_value: bool) -> bool:
    """Whether the operator leads to what is offered. A proxy is a shared pointer, and a part of the parameters a
    handle: after a dot come their own methods. What a call of a proxy returns `is_value`."""
    first, last = steps[0].word.text, steps[-1]
    if is_value or (len(steps) > 1 and is_proxy(first)):
        return operator == "."
    if len(steps) == 1 and last.arguments is None:
        is_value = first in ("parameters", "events", "statemachine")
        return operator == ("." if is_value else "->")
    if last.is_index:
        return operator == "."
    return operator == "->" if last.arguments is not None else operator == "."


def is_uncertain(node: Node) -> bool:
    """Whether a node is in code that may mean something else, or nothing."""
    now: Node | None = node
    while now is not None:
        if now.is_error or now.type == "template_declaration":
            return True
        if now.type.startswith("preproc") and not _is_guard(now):
            return True
        if now.has_error and now.type.endswith(("statement", "declaration", "declarator", "expression", "list")):
            if now.type not in ("compound_statement", "declaration_list", "field_declaration_list"):
                return True
        now = now.parent
    return False


def _is_guard(node: Node) -> bool:
    """Whether a condition of the preprocessor is the guard of a header."""
    if node.type != "preproc_ifdef" or not node.children or text(node.children[0]) != "#ifndef":
        return False
    name = text(field(node, "name"))
    defined = next((child for child in node.named_children if child.type == "preproc_def"), None)
    return defined is not None and text(field(defined, "name")) == name


def worker_around(node: Node) -> str:
    """The class whose method contains a node, '' for other code."""
    now: Node | None = node
    outer = ""
    while now is not None:
        if now.type == "function_definition":
            declarator = now.child_by_field_name("declarator")
            while declarator is not None and declarator.type != "function_declarator":
                declarator = next((one for one in declarator.named_children if "declarator" in one.type), None)
            name = declarator.child_by_field_name("declarator") if declarator is not None else None
            if name is not None and name.type == "qualified_identifier":
                return text(field(name, "scope"))
            outer = "in a class"
        elif now.type in ("class_specifier", "struct_specifier"):
            return text(field(now, "name")) if outer else ""
        now = now.parent
    return ""


def _has_scope(node: Node) -> bool:
    """Whether a qualified name begins with a namespace, not with `::`."""
    return node.child_by_field_name("scope") is not None


def function_around(node: Node) -> Node | None:
    return around(node, ("function_definition",))


def class_around(node: Node) -> str:
    inner = around(node, ("class_specifier", "struct_specifier"))
    return text(field(inner, "name")) if inner is not None else ""


def _called(node: Node) -> Node:
    """The name of a called function, or the node itself."""
    return field(node, "function") if node.type == "call_expression" else node


_IN_SCOPES = frozenset(
    """translation_unit namespace_definition declaration_list declaration preproc_ifdef preproc_if
    linkage_specification""".split()
)
IN_CLASSES = _IN_SCOPES | frozenset(
    """class_specifier struct_specifier field_declaration_list field_declaration declaration function_definition
    pointer_declarator reference_declarator""".split()
)


def of_types(root: Node, types: Collection[str], scopes: Collection[str]) -> Iterator[Node]:
    """The nodes of these types in the scopes, in order."""
    every = preorder([root], lambda node: node.named_children if node.type in scopes else ())
    return (node for node in every if node.type in types)
