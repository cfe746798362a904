"""Building blocks of driving scripts."""
