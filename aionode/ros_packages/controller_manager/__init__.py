"""Launch files import `controller_manager.launch_utils`; a workspace's own takes precedence."""

__all__: list[str] = []
