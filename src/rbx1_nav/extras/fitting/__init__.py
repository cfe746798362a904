"""Fits surfaces to recorded runs."""
