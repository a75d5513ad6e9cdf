"""Generated accessors in this process: the run time that they need is the one in `templates/`."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType
from typing import Any
from unittest import mock

from robocomp_yaml import semantics
from robocomp_yaml.languages import language
from robocomp_yaml.languages.python import parameters as python_parameters
from robocomp_yaml.parameters.kinds import recording
from robocomp_yaml.parameters.types import Parameters
from robocomp_yaml.semantics import composite
from robocomp_yaml.semantics.plain import Conversion
from robocomp_yaml.semantics.reading import PropertyReader
from robocomp_yaml.semantics.references import unresolved

_LAST: list[Any] = []  # the parameters and the module that were asked for last


def python(parameters: Parameters) -> ModuleType:
    """The module `generated/parameters.py` of a component with these parameters."""
    if _LAST and _LAST[0] is parameters:
        return _LAST[1]
    if "generated" not in sys.modules:
        _package("generated", language("python").templates)
        _package("generated.runtime.semantics", Path(semantics.__file__).parent)
    made = ModuleType("generated.parameters")
    text = python_parameters.text(parameters, "Component", "x.pdsl.yaml")
    exec(compile(text, "parameters.py", "exec"), made.__dict__)
    _LAST[:] = [parameters, made]
    return made


def _package(name: str, folder: Path) -> None:
    """A package that is found in a folder where it does not stand."""
    sys.modules[name] = package = ModuleType(name)
    package.__path__ = [str(folder)]


def store(parameters: Parameters, properties: dict[str, str], overrides: dict[str, str] | None = None) -> Any:
    """The parameters of a component that was started with these properties. Raises ParameterError."""
    made = python(parameters)
    from generated.runtime.parameters import Store  # type: ignore[import-not-found]

    return Store(made.TABLE, properties, overrides or {})


def live(parameters: Parameters, properties: dict[str, str], overrides: dict[str, str] | None = None) -> Any:
    """What `self.parameters` is in the worker."""
    made = python(parameters)
    from generated.runtime.parameters import Store

    return made.Parameters(Store(made.TABLE, properties, overrides or {}))


def take(parameters: Parameters, data: Any) -> tuple[Any, list[str]]:
    """Data as the accessors take it: as data again, with defaults; and what is wrong. References are not judged."""
    made = python(parameters)
    from generated.runtime.semantics import composite, references  # type: ignore[import-not-found]
    from generated.runtime.semantics.plain import Conversion  # type: ignore[import-not-found]

    kind, conversion = composite.RecordKind(made.TABLE.values), Conversion()
    with mock.patch.object(references.os, "environ", {}):
        values = kind.convert(data, (), conversion)
    problems = [problem.message for problem in conversion.problems if " comes from the " not in problem.message]
    return (None if problems else composite.data(kind, values)), problems


def put(parameters: Parameters, data: dict[str, Any]) -> tuple[Any, dict[str, str], list[str]]:
    """Data with which a component sets its parameters: as data again, with defaults; its plain values by their paths;
    and what is wrong."""
    made = python(parameters)
    from generated.runtime import editing  # type: ignore[import-not-found]
    from generated.runtime.semantics import composite
    from generated.runtime.semantics.plain import Conversion

    kind, conversion, whole = composite.RecordKind(made.TABLE.values), Conversion(), dict[str, Any]()
    for name, value in data.items():
        assert editing.put(kind, whole, [name], value)
    values = kind.convert(whole, (), conversion)
    problems = [problem.message for problem in conversion.problems]
    if problems:
        return None, {}, problems
    entries = dict(editing.flat(kind, values, {}))
    return composite.data(kind, values), {key: entry.text for key, entry in entries.items()}, []


def read(parameters: Parameters, properties: dict[str, str]) -> tuple[Any, list[str]]:
    """The values that properties give, as data; and what is wrong."""
    python(parameters)
    from generated.runtime.semantics.problems import ParameterError  # type: ignore[import-not-found]

    try:
        return read_back(parameters, properties), []
    except ParameterError as error:
        return None, [problem.message for problem in error.problems]


def read_back(parameters: Parameters, properties: dict[str, str]) -> Any:
    """The values that a component has which was started with these properties, as data."""
    started = store(parameters, properties)
    from generated.runtime.semantics import composite

    return composite.data(started.kind, started.values)


def as_written(parameters: Parameters, properties: dict[str, str]) -> tuple[Any, list[str]]:
    """The same as the compiler reads them, by whose types no reference is followed."""
    kind, conversion = recording(parameters.root), Conversion(is_text=True)
    texts = PropertyReader(properties, {each.path: each for each in parameters.spellings}, unresolved).read(kind)
    taken = kind.convert(texts, (), conversion)
    if conversion.problems:
        return None, [problem.message for problem in conversion.problems]
    return composite.data(kind, taken), []
