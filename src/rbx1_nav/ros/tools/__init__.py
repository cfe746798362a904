"""Building blocks of the tools: bags and markers."""
