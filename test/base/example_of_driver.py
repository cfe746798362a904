#!/usr/bin/python3
"""The test of examples/my_robot fails if the driver sleeps by the wall clock, however long it goes on driving."""
import os
import shutil
import subprocess
import tempfile

import support

EXAMPLES = os.path.join(os.path.dirname(os.path.realpath(__file__)), '..', '..', 'examples')


class TestExampleOfDriver(support.Case):
    def test_wall_time(self):
        folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, folder)
        # under another name: the example itself may be in the workspace
        shutil.copytree(os.path.join(EXAMPLES, 'my_robot'), os.path.join(folder, 'wall_time_robot'))
        for name in 'package.xml', 'nodes/drive.py', 'test/one_metre.py', 'test/one_metre.test':
            path = os.path.join(folder, 'wall_time_robot', name)
            with open(path, encoding='utf-8') as file:
                text = file.read().replace('my_robot', 'wall_time_robot').replace('wall_time_robot.', 'my_robot.')
            if name == 'nodes/drive.py':    # longer than roslaunch waits for a test after the base has exited
                text = (text.replace('import rospy', 'import time\nimport rospy').replace('5 * 20', '60 * 20')
                        .replace('rate.sleep()', 'time.sleep(0.05)'))
            with open(path, 'w', encoding='utf-8') as file:
                file.write(text)
        result = subprocess.run(
            ['rostest', 'wall_time_robot', 'one_metre.test'], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            text=True, timeout=support.LIMIT, check=False, env=dict(
                os.environ, ROS_HOME=folder, ROS_PACKAGE_PATH=f"{folder}:{os.environ['ROS_PACKAGE_PATH']}"))
        self.assertIn('no tick of /clock has prompted', result.stdout)
        self.assertIn('FAILURES: 1', result.stdout)
        self.assertNotEqual(result.returncode, 0, result.stdout)


if __name__ == '__main__':
    support.main(TestExampleOfDriver)
