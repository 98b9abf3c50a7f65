"""Programs import `ros2lifecycle.api`: what `ros2 lifecycle` is made of."""
