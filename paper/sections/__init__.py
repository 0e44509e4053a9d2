"""One module for each experiment, with its sections of the page under the name ``SECTIONS``."""
