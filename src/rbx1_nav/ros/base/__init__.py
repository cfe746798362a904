"""What bases use."""
