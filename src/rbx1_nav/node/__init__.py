"""The life of a node: start and shutdown, command line and parameters, and access to the master and to other nodes."""
