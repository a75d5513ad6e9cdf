"""Pictures of networks: their content (`picture`), how it is derived, and the forms in which it is drawn."""
