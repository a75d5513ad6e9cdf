"""Prints the modules that a Python program imports when it starts, and that are missing in its interpreter.

For a component, the code in `src/` and `generated/` is read, too, with what it needs of a shared run time. The Python
is the one that would run the component: its rule (`interpreter.py`) precedes this text, as `settle`. The program is
not run: paths that it adds as literals are searched, and imports after `Ice.loadSlice` may be defined by a Slice file.
"""

import ast
import importlib.util
import os
import re
import sys


def sources(program):
    folder = os.path.dirname(os.path.abspath(program))
    root = os.path.dirname(folder)
    yield program
    sys.path[:0] = [folder]
    if os.path.basename(folder) == "bin" and os.path.isdir(os.path.join(root, "src")):
        sys.path[:0] = [root, os.path.join(root, "src")]
        own = [path for part in ("generated", "src") for path in below(os.path.join(root, part))]
        yield from own
        yield from shared(os.path.join(root, "generated"), own)


def below(folder):
    for place, _, names in os.walk(folder):
        yield from (os.path.join(place, name) for name in names if name.endswith(".py"))


def shared(folder, own):
    """The packages of a shared run time that the component's own files import."""
    texts = []
    for path in own:
        try:
            with open(path, encoding="utf-8") as file:
                texts.append(file.read())
        except (OSError, ValueError):
            continue
    where = (re.search(r'__file__\)\), "((?:\.\./)+[^"\n]+)"', text) for text in texts)
    for found in filter(None, where):
        runtime = os.path.normpath(os.path.join(folder, found.group(1), "generated"))
        for name in os.listdir(runtime) if os.path.isdir(runtime) else ():
            if any("generated." + name in text for text in texts):
                yield from below(os.path.join(runtime, name))


def imported(tree):
    for statement in tree.body:
        calls = [node.func for node in ast.walk(statement) if isinstance(node, ast.Call)]
        if any(isinstance(call, ast.Attribute) and call.attr == "loadSlice" for call in calls):
            return
        if isinstance(statement, ast.Import):
            yield from (alias.name for alias in statement.names)
        elif isinstance(statement, ast.ImportFrom) and not statement.level:
            yield statement.module


def added_paths(tree):
    for node in ast.walk(tree):
        is_call = isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)
        if is_call and ast.unparse(node.func) in ("sys.path.append", "sys.path.insert"):
            words = (word.value for word in node.args if isinstance(word, ast.Constant))
            yield from (word for word in words if isinstance(word, str))


def is_there(name):
    try:
        return name in sys.modules or importlib.util.find_spec(name) is not None
    except (ImportError, ValueError):
        return False


RULE = ("runtime", "interpreter.py")


def lacks_ice(program):
    """Whether no Python of this host can run a component; otherwise this script continues in one that can."""
    root = os.path.dirname(os.path.dirname(os.path.abspath(program)))
    generated = os.path.join(root, "generated")
    if not any(os.path.isfile(os.path.join(generated, *path)) for path in (("component.py",), RULE)):
        return False
    sys.path[:] = filter(None, sys.path)  # without the working folder
    try:
        settle(root, ["-c", sys.argv[2], *sys.argv[1:]])  # noqa: F821 (defined by interpreter.py)
    except NoPython:  # noqa: F821
        return True
    return False


missing = {"Ice"} if lacks_ice(sys.argv[1]) else set()
trees = []
for path in sources(sys.argv[1]):
    try:
        with open(path, "rb") as file:
            trees.append(ast.parse(file.read()))
    except (OSError, SyntaxError, ValueError):
        continue
for tree in trees:
    sys.path.extend(added_paths(tree))
names = {name.partition(".")[0] for tree in trees for name in imported(tree)}
print(*sorted(missing | {name for name in names if not is_there(name)}))
