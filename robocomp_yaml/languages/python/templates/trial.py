"""Compiles a component's Python to bytecode and imports it once, as its launcher does: `trial.py FOLDER MARK`.

`rcyaml build` runs it with the component's Python, from 3.9 on. It prints each error as a line of JSON after MARK;
other lines are output of the user's code.
"""

from __future__ import annotations

import importlib.util
import json
import linecache
import os
import py_compile
import sys
import traceback
import warnings


def main(root: str) -> int:
    source = os.path.join(root, "src")
    sys.path[:0] = [root, source]
    from generated.runtime import interpreter

    try:
        interpreter.settle(root, sys.argv)
    except interpreter.NoPython as error:
        print(error)
        return 3
    warnings.showwarning = _show_warning
    warnings.simplefilter("always", SyntaxWarning)
    is_fine = all([_compiles(path) for folder in (source, os.path.join(root, "generated")) for path in _code(folder)])
    return 0 if is_fine and _imports(source) else 1


def _code(folder: str) -> list[str]:
    return [
        os.path.join(where, name)
        for where, folders, names in os.walk(folder)
        for name in sorted(names)
        if name.endswith(".py") and "__pycache__" not in where
    ]


def _compiles(path: str) -> bool:
    try:
        # In memory first: compiled files do not repeat warnings.
        with open(path, "rb") as file:
            compile(file.read(), path, "exec", dont_inherit=True)
        py_compile.compile(path, importlib.util.cache_from_source(path), doraise=True)
    except SyntaxError as error:
        _report("error", path, error.lineno, error.offset, f"{type(error).__name__}: {error.msg}", _end(error))
    except (ValueError, py_compile.PyCompileError) as error:  # such as a NUL byte
        _report("error", path, 1, 1, str(error))
    except OSError:  # a read-only folder: it is compiled again each time
        return True
    else:
        return True
    return False


def _end(error: SyntaxError) -> int | None:
    return getattr(error, "end_offset", None) if getattr(error, "end_lineno", None) == error.lineno else None


def _imports(source: str) -> bool:
    from generated.runtime.errors import StartError

    try:
        from generated.component import COMPONENT
    except StartError as error:  # another run time
        print(sys.argv[2] + json.dumps({"kind": "outdated", "text": str(error)}), flush=True)
        return False
    from generated.runtime.settings import Settings
    from generated.runtime.stage import Stage
    from generated.runtime.stopping import Stopping

    try:
        (COMPONENT.stage or Stage)(COMPONENT, Settings([], []), Stopping(), True).worker_class()
    except StartError as error:
        print(error)
        return False
    except (Exception, SystemExit) as error:
        frames = [frame for frame in traceback.extract_tb(error.__traceback__) if _is_in(frame.filename, source)]
        if not frames:
            traceback.print_exc()
            return False
        last = frames[-1]
        line = linecache.getline(last.filename, last.lineno or 1).rstrip("\n")
        begin = len(line) - len(line.lstrip()) + 1
        _report("error", last.filename, last.lineno, begin, f"{type(error).__name__}: {error}", len(line.rstrip()) + 1)
        return False
    return True


def _is_in(path: str, folder: str) -> bool:
    return os.path.abspath(path).startswith(os.path.join(os.path.abspath(folder), ""))


def _show_warning(message: object, category: type, filename: str, lineno: int, *_: object) -> None:
    if issubclass(category, SyntaxWarning):
        _report("warning", filename, lineno, None, f"{category.__name__}: {message}")


def _report(kind: str, path: str, line: int | None, column: int | None, text: str, end: int | None = None) -> None:
    fault = {"kind": kind, "file": path, "line": line or 1, "column": column or 1, "end": end or 0, "text": text}
    print(sys.argv[2] + json.dumps(fault), flush=True)


if __name__ == "__main__":
    code = main(os.path.abspath(sys.argv[1]))
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)  # even if the user's code has started threads
