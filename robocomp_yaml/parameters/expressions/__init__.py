"""Constraints: the types and values of their expressions."""
