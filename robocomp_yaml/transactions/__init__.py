"""Files changed as one: from what is wanted below some folders, to what that changes there, to the disk or not at all.

What the files are about is nobody's business here.
"""
