"""Finds the package in its source folder: the core's tests need neither ROS nor a build."""
import os
import sys

from hypothesis import HealthCheck, settings

sys.path.insert(0, os.path.join(os.path.dirname(__file__), '..', '..', 'src'))

# a busy machine is slow: no test of ours is about time
settings.register_profile('any_machine', deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile('any_machine')
