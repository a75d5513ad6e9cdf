"""Effective values: layers merged, completed and judged."""
