"""Features beside the exercise. The rooms outside this folder never import them; only nodes do."""
