"""Lets systemd start a deployment when its hosts boot."""
