"""Legacy configs: their settings, the parameters that these imply, and the documents of both."""
