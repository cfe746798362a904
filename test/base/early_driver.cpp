// roscpp version of kinds of any_driver.py: early_driver sleep|connection|none
#include <string>

#include <geometry_msgs/Twist.h>
#include <ros/ros.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "early_driver", ros::init_options::AnonymousName);
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<geometry_msgs::Twist>("cmd_vel", 10);
  ros::Rate rate(10);
  std::string kind = argv[1];
  if (kind == "sleep")
    ros::WallDuration(1).sleep();
  while (kind == "connection" && publisher.getNumSubscribers() == 0)
    ros::WallDuration(0.1).sleep();
  for (int number = 0; number < 20; number++)
  {
    geometry_msgs::Twist move;
    move.linear.x = 0.1 + 0.01 * number;
    move.angular.z = 0.03 * number;
    publisher.publish(move);
    rate.sleep();
  }
  publisher.publish(geometry_msgs::Twist());
  ros::Duration(0.5).sleep();   // lets the stop be sent
  return 0;
}
