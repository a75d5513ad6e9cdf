"""Checks of interfaces."""
