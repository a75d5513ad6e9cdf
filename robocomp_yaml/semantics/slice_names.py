# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""Slice identifiers that are not valid in Python."""

from __future__ import annotations

NOT_ESCAPED = ("as", "async", "await", "nonlocal", "staticmethod", "with", "True", "False")
"""Identifiers that Ice 3.7 does not escape. Most are a syntax error; a method `staticmethod` breaks its class."""
