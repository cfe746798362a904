"""Makes Ctrl-C exit without a traceback until a node handles signals itself, and flushes each line of its output.

Import this module first.
"""
import signal
import sys

signal.signal(signal.SIGINT, signal.SIG_DFL)
# also into a file or a pipe, because a script may wait for "Ready"
if hasattr(sys.stdout, 'reconfigure'):      # missing if stdout is closed
    sys.stdout.reconfigure(line_buffering=True)
