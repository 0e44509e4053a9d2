"""Files that are read in a separate process."""
