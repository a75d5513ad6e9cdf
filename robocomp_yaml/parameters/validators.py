"""Compiled JSON Schemas, of which only those used last are kept.

A compiled schema of a dozen parameters needs fifty kilobytes, and is compiled in a fraction of a millisecond: in a
workspace of thousands of components, keeping all of them would need more memory than all documents together.
"""

from __future__ import annotations

import weakref
from collections import OrderedDict
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import jsonschema_rs

MOST = 300  # validators that are kept


class ValuesValidator:
    """Accepts or rejects values by a schema, which is compiled when it is used."""

    __slots__ = ("__weakref__", "_compiled", "_reference")

    def __init__(self) -> None:
        self._compiled: jsonschema_rs.Draft7Validator | None = None
        self._reference = weakref.ref(self)

    def is_valid(self, data: object, schema: Callable[[], dict[str, Any]]) -> bool:
        """Whether the data is valid by the schema, which has to be the same each time."""
        compiled = self._compiled
        if compiled is None:
            compiled = self._compiled = jsonschema_rs.Draft7Validator(schema())
            _used_last[self._reference] = None
        with suppress(KeyError):  # another thread may just have dropped it
            _used_last.move_to_end(self._reference)
        while len(_used_last) > MOST:
            oldest, _ = _used_last.popitem(last=False)
            if (other := oldest()) is not None:
                other._compiled = None
        return compiled.is_valid(data)


_used_last: OrderedDict[weakref.ref[ValuesValidator], None] = OrderedDict()
"""Those that are compiled, the one that was used last at the end."""
