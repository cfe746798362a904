"""What the master, other nodes, their connections and their processes do."""
