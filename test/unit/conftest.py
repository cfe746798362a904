"""Finds the package in its source folder: the core's tests need neither ROS nor a build."""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(__file__), '..', '..', 'src'))
