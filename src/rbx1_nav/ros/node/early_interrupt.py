"""Import this first: until a node handles signals itself, Ctrl-C ends it without a traceback; each line of its output
arrives as soon as it is printed."""
import signal
import sys

signal.signal(signal.SIGINT, signal.SIG_DFL)
# in a file or a pipe, too: a script may wait for "Ready"
if hasattr(sys.stdout, 'reconfigure'):      # not if it is closed
    sys.stdout.reconfigure(line_buffering=True)
