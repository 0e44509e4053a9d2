"""From PyVista meshes to the arrays of a field."""
