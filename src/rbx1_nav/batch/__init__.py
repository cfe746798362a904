"""Many runs: where they are computed, which combinations of parameters they cover, and the file of their results."""
