"""From the program to files: what is to be written (the plan), how it is rendered, and the writing itself."""
