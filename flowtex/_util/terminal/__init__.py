"""Text, tables and bars in a terminal."""
