"""Building blocks of base nodes."""
