"""Plots, drawn with matplotlib.

Each function imports matplotlib when it draws: programs that draw only on request would take twice as long to start.
"""
import logging

# matplotlib cannot save its list of fonts on a full disk; the error of the picture is enough
logging.getLogger('matplotlib.font_manager').setLevel(logging.ERROR)
