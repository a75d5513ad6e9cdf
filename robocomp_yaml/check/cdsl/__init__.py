"""Components: what their lists may say together."""
