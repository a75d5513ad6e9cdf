"""Spellings in text: references, rows, and names of properties."""
