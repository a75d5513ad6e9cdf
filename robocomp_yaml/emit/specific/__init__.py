"""The user's specific class and the skeleton that it came from: what it lacks, and how the two are merged."""
