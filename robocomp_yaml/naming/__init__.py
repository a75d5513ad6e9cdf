"""The names of a program: where each is defined and used, and how to rename one everywhere."""
