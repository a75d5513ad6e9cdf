"""Checks of parameters and values."""
