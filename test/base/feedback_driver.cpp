// roscpp version of feedback_driver.py, without the kind filters: feedback_driver KIND RATE [wall]
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include <geometry_msgs/Twist.h>
#include <nav_msgs/Odometry.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/topic.h>
#include <tf2_ros/transform_listener.h>

const int ODOM_RATE = 50;   // Hz

class Driver
{
public:
  Driver(const std::string& kind, int rate) : kind_(kind), rate_(rate), uses_tf_(kind.find("tf") == 0)
  {
    if (uses_tf_)
      listener_.reset(new tf2_ros::TransformListener(buffer_));
    // a queue of 1: a spin after a sleep finds only the latest message
    subscriber_ = node_.subscribe(kind == "latest_ekf" ? "/odom_ekf" : "/odom", 1, &Driver::onOdom, this);
    publisher_ = node_.advertise<geometry_msgs::Twist>("/cmd_vel", 10);
  }

  bool isReady()
  {
    ros::spinOnce();
    return publisher_.getNumSubscribers() > 0 && odom_ &&
           (!uses_tf_ || buffer_.canTransform("odom", "base_footprint", ros::Time(0)));
  }

  void drive()
  {
    if (kind_ == "callback" || kind_ == "tf_callback")
    {
      answers_ = true;
      while (!done_ && ros::ok())     // as ros::spin() does
        ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
      return;
    }
    if (kind_ == "latest_ekf")        // at 10 Hz: with another phase, the same driver takes another path
    {
      ros::spinOnce();
      const nav_msgs::OdometryConstPtr first = odom_;
      while (odom_ == first && ros::ok())
      {
        ros::Duration(1.0 / ODOM_RATE).sleep();
        ros::spinOnce();
      }
    }
    ros::Rate clock(rate_);
    while (!done_ && ros::ok())
    {
      ros::spinOnce();
      step(ros::Time(0));
      clock.sleep();
    }
  }

private:
  void onOdom(const nav_msgs::OdometryConstPtr& odom)
  {
    odom_ = odom;
    if (answers_ && !done_ && count_++ % (ODOM_RATE / rate_) == 0)
      step(odom->header.stamp);
  }

  void step(const ros::Time& time)
  {
    double x = odom_->pose.pose.position.x, y = odom_->pose.pose.position.y;
    double z = odom_->pose.pose.orientation.z, w = odom_->pose.pose.orientation.w;
    if (uses_tf_)
    {
      const geometry_msgs::Transform pose = buffer_.lookupTransform("odom", "base_footprint", time).transform;
      x = pose.translation.x, y = pose.translation.y, z = pose.rotation.z, w = pose.rotation.w;
    }
    geometry_msgs::Twist twist;
    done_ = x >= 0.999;
    if (!done_)
    {
      twist.linear.x = std::min(std::max(1.0 * (1.0 - x), 0.05), 0.3);
      twist.angular.z = 0.5 * (0.05 - y) - 0.5 * 2 * std::atan2(z, w);
    }
    publisher_.publish(twist);
  }

  std::string kind_;
  int rate_;
  bool uses_tf_;
  bool answers_ = false;
  bool done_ = false;
  int count_ = 0;
  nav_msgs::OdometryConstPtr odom_;
  ros::NodeHandle node_;
  ros::Subscriber subscriber_;
  ros::Publisher publisher_;
  tf2_ros::Buffer buffer_;
  boost::shared_ptr<tf2_ros::TransformListener> listener_;
};

int main(int argc, char** argv)
{
  ros::init(argc, argv, "feedback_driver", ros::init_options::AnonymousName);
  ros::NodeHandle node;   // keeps the node alive
  Driver driver(argv[1], std::atoi(argv[2]));
  if (argc > 3 && argv[3] == std::string("wall"))
  {
    ros::topic::waitForMessage<nav_msgs::Odometry>("/odom");
    while (!driver.isReady())
      ros::WallDuration(0.1).sleep();
  }
  else
  {
    while (!driver.isReady())
      ros::Duration(0.1).sleep();
    ros::Duration(1).sleep();
  }
  driver.drive();
  ros::Duration(0.2).sleep();   // lets the stop be sent
  return 0;
}
