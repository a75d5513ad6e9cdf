"""Values that a document may have, and first documents made of them."""
