// roscpp version of driver_at_rate.py: driver_at_rate RATE,...
#include <iostream>
#include <sstream>
#include <string>

#include <geometry_msgs/Twist.h>
#include <ros/ros.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "driver", ros::init_options::AnonymousName);
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<geometry_msgs::Twist>("/cmd_vel", 10);
  while (publisher.getNumSubscribers() == 0)
    ros::WallDuration(0.02).sleep();
  ros::Time::waitForValid();    // a Rate that begins at time 0 skips its first sleep
  ros::WallDuration(0.3).sleep();
  geometry_msgs::Twist move;
  move.linear.x = 0.2;
  std::istringstream rates(argv[1]);
  std::string text, line;
  for (bool first = true; std::getline(rates, text, ','); first = false)
  {
    if (!first)
    {
      std::cout << "rests" << std::endl;
      std::getline(std::cin, line);
      ros::Duration(0.1).sleep();   // begins on the clock
    }
    int count = std::stoi(text);
    ros::Rate rate(count);
    for (int i = 0; i < count; i++)
    {
      publisher.publish(move);
      rate.sleep();
    }
    publisher.publish(geometry_msgs::Twist());
    ros::Duration(0.2).sleep();   // lets the stop be sent
  }
  return 0;
}
