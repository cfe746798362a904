"""What the filter's node uses."""
