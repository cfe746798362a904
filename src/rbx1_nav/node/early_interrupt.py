"""Makes Ctrl-C exit without a traceback until a node handles signals itself, opens /dev/null in place of a closed
stream, and flushes each line of the output. Hides numpy from rospy in the nodes that do not use it.

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
# rospy works without numpy, and a node then takes 9 MB less memory
if os.path.basename(sys.argv[0]) in ('ekf.py', 'fake_base.py', 'web_view.py'):
    sys.modules.setdefault('numpy', None)       # type: ignore[arg-type]
