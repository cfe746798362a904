"""What other programs use: bags, markers."""
