"""Pictures of networks: what is in one (`picture`), where it comes from, and the forms that it is drawn in."""
