"""What a file declares, held against what it has and what memory has, before a reader opens it."""
