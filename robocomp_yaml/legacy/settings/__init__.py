"""Legacy configs: what their entries are, the parameters they imply, and the documents that say both."""
