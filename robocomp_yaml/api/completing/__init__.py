"""What can be typed at a position of a document, for editors of all kinds."""
