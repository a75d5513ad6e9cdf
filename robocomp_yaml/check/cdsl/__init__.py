"""Checks of components."""
