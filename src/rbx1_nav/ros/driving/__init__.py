"""What a driving script uses."""
