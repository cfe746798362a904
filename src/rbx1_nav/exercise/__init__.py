"""The exercise: its motions, out and back, and the methods by which a script performs them."""
