"""Patterns of texts: which every language of components understands alike, what they match, and a text that fits."""
