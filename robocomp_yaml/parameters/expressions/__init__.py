"""Constraints: the expressions of them read, their types, and what they come to."""
