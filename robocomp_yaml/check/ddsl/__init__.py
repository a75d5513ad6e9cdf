"""Checks of deployments, by the networks that they come to."""
