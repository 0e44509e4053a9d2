"""WebGL2: the data for the client in the browser."""
