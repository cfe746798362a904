"""Import this first: until a node handles signals itself, Ctrl-C ends it without a traceback."""
import signal

signal.signal(signal.SIGINT, signal.SIG_DFL)
