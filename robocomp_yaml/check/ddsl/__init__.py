"""Checks of deployments, on the networks that are derived from them."""
