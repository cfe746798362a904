#!/usr/bin/python3
"""Every run of the exercise ends at the exact pose, to a micrometer."""
import support


class TestFinalPose(support.Case):
    def test_three_runs_end_at_the_exact_pose(self):
        odom = support.OdomWatch()
        for run in range(1, 4):
            driver = support.out_and_back()
            self.assertEqual(driver.wait(), 0, driver.output)
            message = odom.next()
            self.assertEqual(message.twist.twist.linear.x, 0)
            if run == 1:
                x, y = odom.position()
                self.assertAlmostEqual(x, support.EXACT_X, delta=support.MICROMETRE)
                self.assertAlmostEqual(y, support.EXACT_Y, delta=support.MICROMETRE)
            # the heading accumulates over the runs; 1e-6 rad is a micrometer at a distance of 1 m
            self.assertAlmostEqual(support.wrapped(support.yaw(message) - run * support.EXACT_TURN), 0, delta=1e-6)


if __name__ == '__main__':
    support.main(TestFinalPose)
