# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""Names in Slice that Python cannot have."""

from __future__ import annotations

NOT_ESCAPED = ("as", "async", "await", "nonlocal", "staticmethod", "with", "True", "False")
"""Those that Ice 3.7 does not escape: most are a syntax error, and a method `staticmethod` breaks its class."""
