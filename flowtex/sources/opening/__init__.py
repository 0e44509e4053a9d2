"""Opening files, tables and series of datasets with xarray."""
