"""The out-and-back exercise for a differential-drive robot. What the exercise can do without is in `extras`."""
