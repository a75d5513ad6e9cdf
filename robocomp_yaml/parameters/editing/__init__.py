"""Effective values with their origin, and edits of values in documents."""
