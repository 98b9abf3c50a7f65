"""``nav2_map_server map_server``: publishes a map from a file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import aionode
from aionode import DurabilityPolicy, Parameter, QoSProfile
from aionode.errors import escaped
from aionode.interfaces.nav2_msgs.srv import LoadMap
from aionode.interfaces.nav_msgs.msg import OccupancyGrid
from aionode.interfaces.nav_msgs.srv import GetMap
from aionode.lifecycle import LifecycleNode, State, TransitionCallbackReturn
from aionode.programs._map_server.map_file import MapImageError, MapYamlError, load_map

__all__ = ["MapServer", "main"]


class MapServer(LifecycleNode):
    """Publishes the map of `yaml_filename` on `topic_name`, where late subscriptions get it too."""

    def __init__(self, node_name: str = "map_server", **options: Any) -> None:
        super().__init__(node_name, **options)
        self.declare_parameter("yaml_filename", Parameter.Type.STRING)
        topic = self.declare_parameter("topic_name", "map").value
        self.declare_parameter("frame_id", "map")
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.publisher = self.create_lifecycle_publisher(OccupancyGrid, topic, latched)
        self.map: OccupancyGrid | None = None
        self.create_service(GetMap, "~/map", self.get)
        self.create_service(LoadMap, "~/load_map", self.load)

    def read(self, path: str) -> int:
        """Read a map; return the outcome, as a result of `LoadMap`."""
        kind = LoadMap.Response
        if not path:
            self.get_logger().error("YAML file name is empty, can't load!")
            return kind.RESULT_MAP_DOES_NOT_EXIST
        self.get_logger().info(f"Loading yaml file: {path}")
        try:
            grid = load_map(Path(path.removeprefix("file://")))
        except MapYamlError as error:
            self.get_logger().error(f"Failed to parse map YAML: {error}")
            return kind.RESULT_INVALID_MAP_METADATA
        except (MapImageError, ModuleNotFoundError) as error:
            self.get_logger().error(f"Failed to load image file: {error}")
            return kind.RESULT_INVALID_MAP_DATA
        grid.header.frame_id = self.get_parameter("frame_id").value
        grid.header.stamp = grid.info.map_load_time = self.get_clock().now().to_msg()
        self.map = grid
        info = grid.info
        self.get_logger().info(
            f"Read map {path}: {info.width} X {info.height} map @ {info.resolution:g} m/cell"
        )
        return kind.RESULT_SUCCESS

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        """Read the map, if there is one; `~/load_map` may bring it later."""
        self.get_logger().info("Configuring")
        path = self.get_parameter_or("yaml_filename", Parameter("", value="")).value or ""
        if not path:
            self.get_logger().info(
                "yaml-filename parameter is empty, set map through '~/load_map'-service"
            )
        elif self.read(path) != LoadMap.Response.RESULT_SUCCESS:
            self.get_logger().error(f"Failed to load map yaml file: {path}")
            return TransitionCallbackReturn.FAILURE
        return super().on_configure(state)

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Publish the map."""
        self.get_logger().info("Activating")
        result = super().on_activate(state)
        if self.map is not None:
            self.publisher.publish(self.map)
        return result

    def on_cleanup(self, state: State) -> TransitionCallbackReturn:
        """Forget the map."""
        self.map = None
        return super().on_cleanup(state)

    def is_active(self, what: str) -> bool:
        """Return whether requests are answered, and log if not."""
        is_active = self.lifecycle_state.label == "active"
        if not is_active:
            self.get_logger().warning(f"Received {what} request but not in ACTIVE state, ignoring!")
        return is_active

    def get(self, _request: Any, response: GetMap.Response) -> GetMap.Response:
        """Answer with the map."""
        if self.is_active("GetMap") and self.map is not None:
            self.get_logger().info("Handling GetMap request")
            response.map = self.map
        return response

    def load(self, request: LoadMap.Request, response: LoadMap.Response) -> LoadMap.Response:
        """Read another map, and publish it."""
        if not self.is_active("LoadMap"):
            response.result = LoadMap.Response.RESULT_UNDEFINED_FAILURE
            return response
        self.get_logger().info("Handling LoadMap request")
        response.result = self.read(escaped(request.map_url, one_line=True))
        if response.result == LoadMap.Response.RESULT_SUCCESS and self.map is not None:
            response.map = self.map
            self.publisher.publish(self.map)
        return response


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(MapServer)
