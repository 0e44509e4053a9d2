"""TextureSet and settings to pixels, by several hands that know nothing of one another."""
