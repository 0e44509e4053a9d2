"""From xarray's datasets of ocean and weather models to fields."""
