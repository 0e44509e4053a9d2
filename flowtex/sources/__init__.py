"""From files, meshes and labelled arrays to fields."""
