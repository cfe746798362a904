"""Keeps a simulated clock in step with the nodes that drive."""
