"""From bytes to positioned nodes that fit their schema."""
