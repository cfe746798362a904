"""Plots, drawn with matplotlib.

Each function imports matplotlib when it draws: programs that draw only on request would take twice as long to start.
"""
