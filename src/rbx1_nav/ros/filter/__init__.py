"""Building blocks of the filter node."""
