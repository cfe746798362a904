"""Imports the package from its source folder, so that these tests need no build."""
import os
import sys

from hypothesis import HealthCheck, settings

sys.path.insert(0, os.path.join(os.path.dirname(__file__), '..', '..', 'src'))
# what reads and follows the Markdown pages
sys.path.insert(0, os.path.join(os.path.dirname(__file__), '..'))

# no test here is about time, and a busy machine is slow
settings.register_profile('any_machine', deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile('any_machine')
