"""Values merged, completed and judged: what is in effect."""
