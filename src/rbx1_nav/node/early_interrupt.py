"""Makes Ctrl-C exit without a traceback until a node handles signals itself, opens /dev/null in place of a closed
stream, and flushes each line of the output.

Import this module first.
"""
import os
import signal
import sys

signal.signal(signal.SIGINT, signal.SIG_DFL)
for name, mode in ('stdin', 'r'), ('stdout', 'w'), ('stderr', 'w'):
    if getattr(sys, name) is None:      # closed: the next file or socket would get its number
        setattr(sys, name, open(os.devnull, mode))
# also into a file or a pipe, because a script may wait for "Ready"
if hasattr(sys.stdout, 'reconfigure'):      # pytest and notebooks replace the stream
    sys.stdout.reconfigure(line_buffering=True)
