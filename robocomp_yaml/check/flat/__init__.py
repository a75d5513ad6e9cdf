"""Checks of the flat configs of components."""
