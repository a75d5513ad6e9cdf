"""The user's specific class and its skeleton: what the class lacks, and how the two are merged."""
