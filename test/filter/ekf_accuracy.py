#!/usr/bin/python3
"""While the timed script misses, the errors of /odom_ekf are smaller than those of /odom."""
import math

import support


class TestEkfAccuracy(support.Case):
    def test_errors_of_position_and_heading(self):
        odom = support.OdomWatch()
        truth = support.Watch('/ground_truth', support.Odometry)
        ekf = support.Watch('/odom_ekf', support.Odometry)
        # the filter estimates the gyro bias at standstill, for 2 s at 10 poses per second
        support.wait_for(lambda: truth.last and len(ekf.messages) > 20, '/odom_ekf')
        driver = support.out_and_back()
        self.assertEqual(driver.wait(), 0, driver.output)
        ekf.next()

        true = {m.header.stamp: support.pose(m) for m in list(truth.messages)}

        def errors(messages):
            """Return the root mean square errors of position (m) and heading (rad)."""
            pairs = [(support.pose(m), true[m.header.stamp]) for m in list(messages) if m.header.stamp in true]
            self.assertGreater(len(pairs), 100)
            return (math.sqrt(sum((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 for a, b in pairs) / len(pairs)),
                    math.sqrt(sum(support.wrapped(a[2] - b[2]) ** 2 for a, b in pairs) / len(pairs)))
        position, heading = errors(odom.messages)
        ekf_position, ekf_heading = errors(ekf.messages)
        self.assertLess(ekf_heading, heading / 3)
        self.assertLess(ekf_position, position)


if __name__ == '__main__':
    support.main(TestEkfAccuracy)
