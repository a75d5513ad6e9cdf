"""Values looked at and changed in their documents."""
