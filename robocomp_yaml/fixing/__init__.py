"""Fixes carried out: which of those that diagnostics have are applied to the documents, and how they are written."""
