"""A simulated robot, the floor below it, and the clock that it keeps in step with its drivers."""
