"""An emulated iRobot Create on a serial line."""
