from setuptools import setup

from catkin_pkg.python_setup import generate_distutils_setup

ROOMS = ['base', 'driving', 'exercise', 'filter', 'node', 'simulation',
         'extras', 'extras.create', 'extras.create.emulator', 'extras.fitting', 'extras.lockstep', 'extras.many_runs',
         'extras.web']
setup(**generate_distutils_setup(packages=['rbx1_nav'] + ['rbx1_nav.' + room for room in ROOMS],
                                 package_dir={'': 'src'}))
