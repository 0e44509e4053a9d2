"""From meshes and files to fields."""
