"""An emulated iRobot Create at the other end of a serial line."""
