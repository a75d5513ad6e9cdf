"""The types of parameters resolved: names looked up, limits joined and judged."""
