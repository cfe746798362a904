"""A simulated robot and the floor below it."""
