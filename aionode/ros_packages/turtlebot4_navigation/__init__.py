"""Programs import `turtlebot4_navigation.turtlebot4_navigator` to give a TurtleBot 4 tasks."""
