"""TextureSet and settings to pixels, by renderers that know nothing of one another."""
