"""Start and shutdown of a node, and its command line, parameters, logging and interrupts."""
