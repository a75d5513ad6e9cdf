"""From the program to files: what is to be written (the plan), and how it is rendered."""
