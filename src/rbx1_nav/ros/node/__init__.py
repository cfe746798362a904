"""The life of a node: command line, parameters, logging, interrupts."""
