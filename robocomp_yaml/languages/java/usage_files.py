"""Where one file of Java uses a name of the worker: `mouth_proxy.move(pose)`, `this.parameters.speed()`."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

from tree_sitter import Node

from robocomp_yaml.digraph import preorder
from robocomp_yaml.emit.specific.code import around, field, text
from robocomp_yaml.emit.usage.code import MODULES, WORKER, Arguments, Chain, Constant, Step, Word
from robocomp_yaml.languages._shared.usage_file import UsageFile
from robocomp_yaml.languages.java.code import COMMENTS, parse
from robocomp_yaml.languages.java.names import PACKAGE

# The fields and parents in which an identifier is declared, or means something else. Everywhere else, it is used.
_DECLARES = {
    "catch_formal_parameter": "name", "enhanced_for_statement": "name", "formal_parameter": "name",
    "instanceof_expression": "name", "lambda_expression": "parameters", "resource": "name",
    "variable_declarator": "name",
}  # fmt: skip
_OTHERS = frozenset(
    """annotation class_declaration constructor_declaration element_value_pair enum_constant enum_declaration
    inferred_parameters interface_declaration labeled_statement marker_annotation method_declaration
    record_declaration record_pattern_component type_parameter type_pattern""".split()
)
_CLASSES = ("class_declaration", "enum_declaration", "record_declaration", "interface_declaration", "class_body")
_METHODS = ("method_declaration", "constructor_declaration")
_EQUALS = ("equals", "equalsIgnoreCase", "contentEquals")
_NUMBER = re.compile(r"(-?)\s*(\d[\d_]*|\d*\.\d+|\d+\.\d*)([fFdDlL]?)\Z")


class JavaFile(UsageFile):
    def __init__(self, path: str, source: str) -> None:
        super().__init__(path, source, parse)

    def classes(self) -> Iterator[tuple[str, list[str]]]:
        """The classes, each with the class that it extends."""
        for node in _of_type(self._tree.root_node, "class_declaration"):
            above = node.child_by_field_name("superclass")
            names = [text(one) for one in above.named_children] if above is not None else []
            yield text(field(node, "name")), [name.rpartition(".")[2] for name in names[:1]]

    def methods(self, workers: Collection[str]) -> Iterator[Word]:
        """The names of the methods of the worker's classes."""
        for node in _of_type(self._tree.root_node, "method_declaration"):
            if _class_around(node) in workers:
                yield self._word(field(node, "name"))

    def imported(self) -> Iterator[tuple[str, ...]]:
        """What the file imports of the Slice: the names of modules and types, `*` for all types."""
        for node in self._tree.root_node.children:
            if node.type == "import_declaration":
                names = re.sub(r"\s|\bimport\b|\bstatic\b|;", " ", text(node)).replace(" ", "").split(".")
                if names[0] == PACKAGE:
                    yield tuple(names[1:])

    def declares(self, name: str) -> bool:
        """Whether the file declares a variable, parameter, field or type of this name."""
        return any(self._is_declared(node) for node in self._nodes(name))

    def chains(self, name: str, workers: Collection[str]) -> Iterator[Chain]:
        """The chains that begin with a name of the worker, also through variables that they initialize."""
        for node in self._nodes(name):
            start = self._start(node, workers)
            if start is None:
                continue
            steps, end = self._steps([Step(self._word(node))], start)
            yield Chain(WORKER, tuple(steps))
            yield from self._compared(WORKER, steps, end)
            yield from self._through_variable(WORKER, steps, end)

    def qualified(self) -> Iterator[Chain]:
        """The names in Slice modules: `slice.RoboCompMouth.Shape.round`."""
        for node in self._nodes(PACKAGE):
            if self._is_declared(node) or is_uncertain(node):
                continue
            steps: list[Step] = []
            now = node
            while (parent := now.parent) is not None:
                name = parent.named_children[-1] if parent.named_children else None
                is_path = parent.type in ("scoped_identifier", "scoped_type_identifier", "field_access")
                if not is_path or name is None or parent.named_children[0] != now or "identifier" not in name.type:
                    break
                steps.append(Step(self._word(name)))
                now = parent
            if steps:
                yield Chain(MODULES, tuple(steps))

    def of_type(self, name: str, module: str) -> Iterator[Chain]:
        """The uses of an imported type of a module: `Shape.round`."""
        for node in self._nodes(name):
            parent = node.parent
            if parent is None or parent.type != "field_access" or parent.child_by_field_name("object") != node:
                continue
            member = field(parent, "field")
            if member.type == "identifier" and not is_uncertain(node):
                head = Step(Word(module, self._word(node).span))
                yield Chain(MODULES, (head, Step(self._word(node)), Step(self._word(member))))

    def _nodes(self, name: str) -> Iterator[Node]:
        """The nodes that are this word, except in comments and texts."""
        for node in self._found(name, 0, len(self._bytes)):
            if node.type in ("identifier", "type_identifier") and text(node) == name:
                yield node

    def _is_declared(self, node: Node) -> bool:
        parent = node.parent
        if parent is None or parent.type in _OTHERS:
            return True
        return parent.type in _DECLARES and parent.child_by_field_name(_DECLARES[parent.type]) == node

    def _start(self, node: Node, workers: Collection[str]) -> Node | None:
        """The node at which a chain begins, if the word is a use of the worker."""
        parent = node.parent
        if parent is None or node.type != "identifier" or self._is_declared(node) or is_uncertain(node):
            return None
        start = node
        if parent.type == "field_access" and parent.child_by_field_name("field") == node:
            owner = text(field(parent, "object")).replace(" ", "")
            if owner != "this" and owner.removesuffix(".this") not in workers:
                return None  # that of another object
            if owner == "this" and _class_around(node) not in workers:
                return None
            start = parent
        elif parent.type == "method_invocation" and parent.child_by_field_name("name") == node:
            return None
        elif parent.type in ("scoped_identifier", "switch_label", "break_statement", "continue_statement"):
            return None
        elif parent.type == "method_reference" and parent.named_children[0] != node:
            return None
        elif not _is_in_worker(node, workers):
            return None
        return start

    def _steps(self, head: list[Step], start: Node) -> tuple[list[Step], Node]:
        """The steps of a chain that begins with some at a node, and the node at which it ends."""
        steps, now = list(head), start
        while (parent := now.parent) is not None:
            if parent.type == "field_access" and parent.child_by_field_name("object") == now:
                name = field(parent, "field")
                if name.type != "identifier":
                    break
                steps.append(Step(self._word(name)))
            elif parent.type == "method_invocation" and parent.child_by_field_name("object") == now:
                steps.append(Step(self._word(field(parent, "name")), self._arguments(parent)))
            elif parent.type == "method_reference" and parent.named_children[0] == now:
                if len(parent.named_children) == 2:
                    steps.append(Step(self._word(parent.named_children[1])))
                return steps, parent
            elif parent.type == "array_access" and parent.child_by_field_name("array") == now:
                steps.append(self._index())
            elif parent.type != "parenthesized_expression":
                break
            now = parent
        return steps, now

    def typed(self, name: str, module: str) -> Iterator[Chain]:
        """The chains that begin at variables and parameters of a type, and the constructions of its values. `name` is
        an imported type of the module, or the package of all."""
        for node in self._nodes(name):
            named, word = node, node
            if name == PACKAGE:  # `slice.RoboCompMouth.Pose`
                middle = node.parent
                outer = middle.parent if middle is not None else None
                if middle is None or outer is None or outer.type != "scoped_type_identifier":
                    continue
                if text(middle.named_children[-1]) != module or middle.named_children[0] != node:
                    continue
                named, word = outer, outer.named_children[-1]
            if named.type not in ("type_identifier", "scoped_type_identifier") or is_uncertain(named):
                continue
            parent = named.parent
            head = [Step(Word(module, self._word(named).span))]
            value = [*head, Step(self._word(word), Arguments(is_exact=False))]
            if parent is not None and parent.type == "object_creation_expression":
                if parent.child_by_field_name("type") == named and _class_body(parent) is None:
                    yield Chain(MODULES, (*head, Step(self._word(word), self._arguments(parent))))
                continue
            if parent is None or parent.child_by_field_name("type") != named:
                continue
            if parent.type in ("formal_parameter", "enhanced_for_statement"):
                yield from self._of_variable(MODULES, value, field(parent, "name"), parent)
            elif parent.type == "local_variable_declaration":
                for declarator in parent.children_by_field_name("declarator"):
                    if declarator.child_by_field_name("dimensions") is None:
                        yield from self._of_variable(MODULES, value, field(declarator, "name"), parent)

    def _compared(self, root: str, steps: list[Step], end: Node) -> Iterator[Chain]:
        """A comparison of a chain with a literal: `mode().equals("fast")`, `"fast".equals(mode())`, `speed() == 5`, or
        in a switch."""
        found: list[Constant | None] = []
        last, parent = steps[-1], end.parent
        if last.arguments is not None and last.word.text in _EQUALS and last.arguments.values:
            steps, found = steps[:-1], list(last.arguments.values[:1])
        elif parent is not None and parent.type == "argument_list" and len(parent.named_children) == 1:
            call = parent.parent
            if call is not None and call.type == "method_invocation" and text(field(call, "name")) in _EQUALS:
                owner = call.child_by_field_name("object")
                found = [self._literal(owner)] if owner is not None else []
        elif parent is not None and parent.type == "binary_expression":
            if text(field(parent, "operator")) in ("==", "!="):
                sides = (field(parent, "left"), field(parent, "right"))
                found = [self._literal(sides[0] if sides[1] == end else sides[1])]
        else:
            found = list(self._labels(end))
        compared = tuple(one for one in found if one is not None)
        if compared and steps and not is_uncertain(end):
            yield Chain(root, tuple(steps), compared=compared, is_again=True)

    def _labels(self, end: Node) -> Iterator[Constant | None]:
        """The literal labels of a switch over a value."""
        switch = end.parent
        while switch is not None and switch.type == "parenthesized_expression":
            switch = switch.parent
        if switch is None or switch.type != "switch_expression" or (body := switch.child_by_field_name("body")) is None:
            return
        for group in body.named_children:
            for label in group.named_children:
                if label.type == "switch_label":
                    yield from map(self._literal, label.named_children)

    def _through_variable(self, root: str, steps: list[Step], end: Node) -> Iterator[Chain]:
        """The chains that begin at a local variable, if a chain initializes it, and no other of its name is near."""
        parent = end.parent
        is_loop = parent is not None and parent.type == "enhanced_for_statement"
        if parent is None or parent.type not in ("variable_declarator", "enhanced_for_statement", "resource"):
            return
        if parent.child_by_field_name("value") != end:
            return
        each = self._index(is_each=True)
        yield from self._of_variable(root, [*steps, each] if is_loop else steps, field(parent, "name"), end)

    def _of_variable(self, root: str, steps: list[Step], name: Node, declaration: Node) -> Iterator[Chain]:
        """The chains of a variable that stands for some steps."""
        method = around(declaration, _METHODS)
        if method is None or name.type != "identifier":
            return
        inside = [one for one in self._nodes(text(name)) if method.start_byte <= one.start_byte < method.end_byte]
        if any(self._is_declared(one) for one in inside if one != name):
            return
        for node in inside:
            outer = node.parent
            if node == name or outer is None or is_uncertain(node):
                continue
            if outer.type in ("field_access", "method_invocation") and outer.child_by_field_name("object") != node:
                if outer.type == "field_access" or outer.child_by_field_name("name") == node:
                    continue
            longer, end = self._steps(steps, node)
            if len(longer) > len(steps):
                yield Chain(root, tuple(longer))
            yield from self._compared(root, longer, end)
            if node.start_byte > name.start_byte:
                yield from self._through_variable(root, longer, end)

    def _arguments(self, call: Node) -> Arguments:
        nodes = [one for one in field(call, "arguments").named_children if one.type not in COMMENTS]
        return self._arguments_of(nodes, not field(call, "arguments").has_error, self._keys(nodes))

    def _keys(self, nodes: list[Node]) -> tuple[Word, ...]:
        """The keys of a literal map: `Map.of("low", 5, "high", 9)`."""
        if len(nodes) != 1 or nodes[0].type != "method_invocation":
            return ()
        if not re.fullmatch(r"(?:java\.util\.)?Map\.of", text(nodes[0]).partition("(")[0].strip()):
            return ()
        every = [one for one in field(nodes[0], "arguments").named_children if one.type not in COMMENTS]
        found = [self._literal(one) for one in every[::2]]
        return tuple(self._inner(one) for one in found if one is not None and isinstance(one.value, str))

    def _value_of(self, node: Node) -> str | int | float | None:
        written = text(node)
        value: str | int | float | None = None
        if node.type.endswith("_literal") or node.type == "unary_expression":
            if (number := _NUMBER.match(written)) and not re.match(r"-?\s*0\d", written):
                digits = number[2].replace("_", "")
                is_whole = digits.isdigit() and number[3].lower() in ("", "l")
                value = (int if is_whole else float)(number[1] + digits)
            elif written in ("true", "false"):
                value = written == "true"
            elif node.type == "string_literal" and "\\" not in written and not written.startswith('"""'):
                value = written[1:-1]
        elif node.type in ("true", "false"):
            value = node.type == "true"
        return value


def is_uncertain(node: Node) -> bool:
    """Whether a node is near a syntax error."""
    now: Node | None = node
    while now is not None and not now.type.endswith(("_body", "program")):
        if now.is_error or (now.has_error and now.type not in ("block", "method_declaration", "class_declaration")):
            return True
        now = now.parent
    return False


def _around(node: Node) -> Iterator[Node]:
    """The nodes that define a class around a node, the innermost first."""
    now = node.parent
    while now is not None:
        if now.type in _CLASSES[:4] or (now.type == "class_body" and now.parent and "object" in now.parent.type):
            yield now
        now = now.parent


def _class_body(creation: Node) -> Node | None:
    """The body of an anonymous class."""
    return next((child for child in creation.named_children if child.type == "class_body"), None)


def _class_around(node: Node) -> str:
    """The innermost class around a node, '' if it has no name."""
    inner = next(_around(node), None)
    return text(field(inner, "name")) if inner is not None and inner.type == "class_declaration" else ""


def _is_in_worker(node: Node, workers: Collection[str]) -> bool:
    """Whether a name without an object means one of the worker, as far as other classes cannot have it."""
    for one in _around(node):
        if one.type == "class_declaration" and text(field(one, "name")) in workers:
            return True
        if one.type != "class_declaration" or one.child_by_field_name("superclass") is not None:
            return False
    return False


def _of_type(root: Node, type_: str) -> Iterator[Node]:
    """The nodes of a type, in order, also in classes inside of others, but not in methods."""
    scopes = ("program", "class_declaration", "class_body")
    every = preorder([root], lambda node: node.named_children if node.type in scopes else ())
    return (node for node in every if node.type == type_)
