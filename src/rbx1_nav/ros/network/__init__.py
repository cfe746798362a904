"""Access to the master and to other nodes, and monitoring of their connections and processes."""
