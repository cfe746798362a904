"""What the robot is to do: motions, legs, and the gate that every command passes."""
