"""Constraints: the types of their expressions, and what they come to."""
