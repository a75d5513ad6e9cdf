"""Changes to files as one transaction: plans, the changes that they make on the disk, and their application.

This package does not know what the files are about.
"""
