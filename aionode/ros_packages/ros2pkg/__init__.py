"""Programs import `ros2pkg.api`: what `ros2 pkg` is made of."""
