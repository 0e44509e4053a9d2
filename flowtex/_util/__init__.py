"""What every room uses: progress, whole files, caches, optional parts."""
