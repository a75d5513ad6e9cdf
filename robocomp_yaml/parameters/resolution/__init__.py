"""Resolution of the types of parameters: names are looked up, limits are combined and checked."""
