"""Examples of values, and first documents with them."""
