"""Building blocks of every base, simulated or real: robot description, kinematics, command gate, clocks, messages."""
