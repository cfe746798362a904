"""The iRobot Create on a serial line: its protocol, a driver, and an emulated robot."""
