"""Serving pages: sessions, files and who may have them."""
