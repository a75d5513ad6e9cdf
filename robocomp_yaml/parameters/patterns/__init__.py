"""Patterns of texts: the subset that all languages of components support, matching, and examples of matching texts."""
