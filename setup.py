from setuptools import setup

from catkin_pkg.python_setup import generate_distutils_setup

ROOMS = ['batch', 'control', 'create', 'create.driver', 'create.emulator', 'driving', 'estimation', 'fitting', 'plotting',
         'robot', 'ros', 'ros.base', 'ros.filter', 'ros.lockstep', 'ros.network', 'ros.node', 'ros.web', 'simulation']
setup(**generate_distutils_setup(packages=['rbx1_nav'] + ['rbx1_nav.' + room for room in ROOMS],
                                 package_dir={'': 'src'}))
