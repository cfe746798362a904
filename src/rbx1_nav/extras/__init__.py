"""Features beside the exercise. Outside this folder, only nodes import them."""
