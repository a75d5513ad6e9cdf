"""State machines on their way into a component: tables, and the tables as text of a language."""
