// Like driver_at_rate with a ros::Timer: timer_driver RATE COUNT
#include <cstdlib>

#include <geometry_msgs/Twist.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "timer_driver", ros::init_options::AnonymousName);
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<geometry_msgs::Twist>("/cmd_vel", 10);
  while (publisher.getNumSubscribers() == 0)
    ros::Duration(0.1).sleep();
  ros::Duration(1).sleep();
  int left = std::atoi(argv[2]);
  ros::Timer timer = node.createTimer(ros::Duration(1 / std::atof(argv[1])), [&](const ros::TimerEvent&)
  {
    geometry_msgs::Twist command;
    command.linear.x = left > 0 ? 0.2 : 0.0;
    if (left-- >= 0)
      publisher.publish(command);
  });
  while (left >= 0 && ros::ok())    // as ros::spin() does
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
  ros::Duration(0.2).sleep();   // lets the stop be sent
  return 0;
}
