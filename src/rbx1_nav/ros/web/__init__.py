"""What the web view uses: what the page shows, who may connect, and how a browser drives the robot."""
