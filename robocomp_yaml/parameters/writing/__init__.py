"""Effective values as properties and TOML, and the reference of parameters in Markdown."""
