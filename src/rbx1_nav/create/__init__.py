"""The iRobot Create at the other end of a serial line: its protocol, a driver, and an emulated robot."""
