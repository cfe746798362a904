"""A simulated robot, the floor below it, and a simulated clock that stays in step with the drivers."""
