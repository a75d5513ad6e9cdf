"""From RoboComp's legacy formats to our documents. Grammars and rules are data, in `migrate/`."""
