"""State machines: what a schema cannot say of them."""
