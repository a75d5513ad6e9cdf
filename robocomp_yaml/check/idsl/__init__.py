"""Interfaces: names, references, cycles, and what Slice cannot say."""
