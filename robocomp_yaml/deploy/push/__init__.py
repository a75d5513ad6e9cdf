"""Brings the files of a deployment to its other hosts."""
