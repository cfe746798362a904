"""From recorded runs to a surface."""
