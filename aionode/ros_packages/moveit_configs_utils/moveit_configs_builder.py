"""`moveit_configs_utils.moveit_configs_builder`: the parameters of MoveIt in a robot's package."""

from __future__ import annotations

import logging
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Self

from aionode._distribution import choose_distribution
from launch.substitution import SomeSubstitutionsType
from launch_param_builder import (
    ParameterBuilder,
    ParameterBuilderFileNotFoundError,
    get_path,
    load_xacro,
    load_yaml,
)
from launch_ros.parameter_descriptions import ParameterValue
from moveit_configs_utils._pipelines import default_pipelines, ompl_planner_configs
from moveit_configs_utils.substitutions import Xacro

__all__ = ["MoveItConfigs", "MoveItConfigsBuilder"]

Parameters = dict[str, Any]
Mappings = Mapping[SomeSubstitutionsType, SomeSubstitutionsType]

CONFIG: Final = Path("config")
PILZ: Final = "pilz_industrial_motion_planner"
LOG: Final = logging.getLogger(__name__)


@dataclass(slots=True)
class MoveItConfigs:
    """The parameters of MoveIt's nodes for a robot, by what they are for."""

    package_path: Path | None = None
    robot_description: Parameters = field(default_factory=dict)
    robot_description_semantic: Parameters = field(default_factory=dict)
    robot_description_kinematics: Parameters = field(default_factory=dict)
    planning_pipelines: Parameters = field(default_factory=dict)
    trajectory_execution: Parameters = field(default_factory=dict)
    planning_scene_monitor: Parameters = field(default_factory=dict)
    sensors_3d: Parameters = field(default_factory=dict)
    move_group_capabilities: Parameters = field(
        default_factory=lambda: {"capabilities": "", "disable_capabilities": ""}
    )
    joint_limits: Parameters = field(default_factory=dict)
    moveit_cpp: Parameters = field(default_factory=dict)
    pilz_cartesian_limits: Parameters = field(default_factory=dict)

    def to_dict(self) -> Parameters:
        """Return the parameters of a node, in one dict."""
        parameters = {
            **self.robot_description,
            **self.robot_description_semantic,
            **self.robot_description_kinematics,
            **self.planning_pipelines,
            **self.trajectory_execution,
            **self.planning_scene_monitor,
            **self.sensors_3d,
            **self.joint_limits,
            **self.moveit_cpp,
        }
        for name, limits in self.pilz_cartesian_limits.items():
            parameters[name] = {**parameters.get(name, {}), **limits}
        return parameters


class MoveItConfigsBuilder(ParameterBuilder):
    """Collects MoveIt's parameters from the package that its Setup Assistant wrote for a robot.

    What a launch file does not name has the file that the Setup Assistant gives it.

    Args:
        robot_name: The name of the robot.
        robot_description: The parameter of the URDF, with which those of the SRDF, the kinematics
            and the limits begin.
        package_name: The package, which is ``ROBOT_NAME_moveit_config`` otherwise.
    """

    def __new__(
        cls,
        robot_name: str,
        robot_description: str = "robot_description",  # noqa: ARG004  # as of __init__
        package_name: str | None = None,
    ) -> Any:
        """Return a builder, or what stands for it."""
        return super().__new__(cls, package_name or f"{robot_name}_moveit_config")

    def __init__(
        self,
        robot_name: str,
        robot_description: str = "robot_description",
        package_name: str | None = None,
    ) -> None:
        super().__init__(package_name or f"{robot_name}_moveit_config")
        self._configs = MoveItConfigs(package_path=self._package_path)
        self._robot_name = robot_name
        self._description = robot_description
        config = self._setup_assistant()
        urdf = config.get("urdf", config.get("URDF")) or {}
        srdf = config.get("srdf", config.get("SRDF")) or {}
        wrapper = self._package_path / CONFIG / f"{robot_name}.urdf.xacro"
        if wrapper.exists():
            self._urdf = wrapper
        elif urdf:
            self._urdf = Path(get_path(urdf["package"], urdf["relative_path"]))
        else:
            self._urdf = self._guessed("URDF")
        pairs = [text.partition(":=") for text in (urdf.get("xacro_args") or "").split()]
        self._xacro_arguments: Mappings = {name: value for name, _, value in pairs}
        self._srdf = Path(srdf["relative_path"]) if srdf else self._guessed("SRDF")

    def robot_description(
        self, file_path: str | Path | None = None, mappings: Mappings | None = None
    ) -> Self:
        """Add the URDF, which xacro makes, with the given arguments.

        A file that is not there is a warning: MoveIt then waits for the topic.
        """
        path = self._path(file_path, self._urdf)
        texts = mappings or self._xacro_arguments
        try:
            self._configs.robot_description = {self._description: described(path, texts)}
        except ParameterBuilderFileNotFoundError as error:
            LOG.warning("%s; using the topic /robot_description instead", error.args[0])
        return self

    def robot_description_semantic(
        self, file_path: str | Path | None = None, mappings: Mappings | None = None
    ) -> Self:
        """Add the SRDF, which xacro makes, with the given arguments."""
        text = described(self._path(file_path, self._srdf), mappings)
        self._configs.robot_description_semantic = {f"{self._description}_semantic": text}
        return self

    def robot_description_kinematics(self, file_path: str | Path | None = None) -> Self:
        """Add the solvers of kinematics."""
        self._configs.robot_description_kinematics = {
            f"{self._description}_kinematics": self._yaml(file_path, "kinematics.yaml")
        }
        return self

    def joint_limits(self, file_path: str | Path | None = None) -> Self:
        """Add the limits of joints that replace those of the URDF."""
        self._configs.joint_limits = {
            f"{self._description}_planning": self._yaml(file_path, "joint_limits.yaml")
        }
        return self

    def moveit_cpp(self, file_path: str | Path | None = None) -> Self:
        """Add the parameters of MoveItCpp."""
        self._configs.moveit_cpp = self._yaml(file_path, "moveit_cpp.yaml")
        return self

    def trajectory_execution(
        self, file_path: str | Path | None = None, moveit_manage_controllers: bool = True
    ) -> Self:
        """Add which controllers carry out trajectories.

        Raises:
            RuntimeError: No file is given, and the package has several that fit.
        """
        path = self._controllers() if file_path is None else self._path(file_path)
        self._configs.trajectory_execution = {
            "moveit_manage_controllers": moveit_manage_controllers,
            **(load_yaml(path) if path else {}),
        }
        return self

    def planning_scene_monitor(
        self,
        publish_planning_scene: bool = True,
        publish_geometry_updates: bool = True,
        publish_state_updates: bool = True,
        publish_transforms_updates: bool = True,
        publish_robot_description: bool = False,
        publish_robot_description_semantic: bool = False,
    ) -> Self:
        """Add what of the planning scene is published."""
        self._configs.planning_scene_monitor = {
            "publish_planning_scene": publish_planning_scene,
            "publish_geometry_updates": publish_geometry_updates,
            "publish_state_updates": publish_state_updates,
            "publish_transforms_updates": publish_transforms_updates,
            "publish_robot_description": publish_robot_description,
            "publish_robot_description_semantic": publish_robot_description_semantic,
        }
        return self

    def sensors_3d(self, file_path: str | Path | None = None) -> Self:
        """Add the sensors that see obstacles, if the package has a file of them."""
        path = self._path(file_path, CONFIG / "sensors_3d.yaml")
        sensors = load_yaml(path) if path.exists() else {}
        if any((sensors.get("sensors") or [])[:1]):
            self._configs.sensors_3d = sensors
        return self

    def planning_pipelines(
        self,
        default_planning_pipeline: str | None = None,
        pipelines: list[str] | None = None,
        load_all: bool = True,
    ) -> Self:
        """Add the planners.

        Args:
            default_planning_pipeline: The one that is used unless a request names another one;
                ``ompl`` if it is there, else the first.
            pipelines: Their names; those that the package has a ``NAME_planning.yaml`` of
                otherwise.
            load_all: Whether those come with MoveIt's own, if none are named.

        Raises:
            RuntimeError: The default is not among them.
        """
        defaults = default_pipelines(choose_distribution(os.environ, None))
        if pipelines is None:
            pipelines = self._names("_planning.yaml")
            pipelines += [name for name in defaults if load_all and name not in pipelines]
        default = default_planning_pipeline or next(
            (name for name in ["ompl", *pipelines] if name in pipelines), None
        )
        if default not in pipelines:
            raise RuntimeError(
                f"default_planning_pipeline: {default!r} is none of the pipelines "
                f"{', '.join(pipelines) or '(there are none)'}"
            )
        found = {name: self._pipeline(name, defaults) for name in pipelines}
        if "ompl" in found:
            found["ompl"].setdefault("planner_configs", ompl_planner_configs())
        self._configs.planning_pipelines = {
            "planning_pipelines": pipelines,
            "default_planning_pipeline": default,
            **found,
        }
        return self

    def pilz_cartesian_limits(self, file_path: str | Path | None = None) -> Self:
        """Add the limits in space that the planner of Pilz keeps."""
        if (self._package_path / CONFIG / "cartesian_limits.yaml").exists():
            LOG.warning("cartesian_limits.yaml is deprecated: rename it pilz_cartesian_limits.yaml")
        self._configs.pilz_cartesian_limits = {
            f"{self._description}_planning": self._yaml(file_path, "pilz_cartesian_limits.yaml")
        }
        return self

    def to_moveit_configs(self) -> MoveItConfigs:
        """Return the parameters, after what was not added has been, from the usual files."""
        for name in (
            *("robot_description", "robot_description_semantic", "robot_description_kinematics"),
            *("planning_pipelines", "trajectory_execution", "planning_scene_monitor"),
            *("sensors_3d", "joint_limits"),
        ):
            if not getattr(self._configs, name):
                getattr(self, name)()
        if PILZ in self._configs.planning_pipelines and not self._configs.pilz_cartesian_limits:
            self.pilz_cartesian_limits()
        return self._configs

    def to_dict(self, include_moveit_configs: bool = True) -> Parameters:
        """Return the parameters in one dict, with those of MoveIt unless they are not wanted."""
        if include_moveit_configs:
            self._parameters.update(self.to_moveit_configs().to_dict())
        return self._parameters

    def _setup_assistant(self) -> Parameters:
        """Return the files and arguments that the Setup Assistant was given, if it says so."""
        file = self._package_path / ".setup_assistant"
        content = (load_yaml(file) or {}) if file.exists() else {}
        return content.get("moveit_setup_assistant_config") or {}

    def _guessed(self, kind: str) -> Path:
        """Return the usual path of a description that the package does not name."""
        path = CONFIG / f"{self._robot_name}.{kind.lower()}"
        LOG.warning("%s does not name the %s; using %s", self._package_path, kind, path)
        return path

    def _path(self, file_path: str | Path | None, default: Path | None = None) -> Path:
        """Return the path of a file of the package."""
        return self._package_path / (file_path or default or "")

    def _yaml(self, file_path: str | Path | None, name: str) -> Any:
        """Return the content of a file of the package, which has a usual name."""
        return load_yaml(self._path(file_path, CONFIG / name))

    def _names(self, end: str) -> list[str]:
        """Return the names before this end that files of the package's configuration have."""
        files = (self._package_path / CONFIG).glob(f"*{end}")
        return [file.name.removesuffix(end) for file in sorted(files) if file.is_file()]

    def _controllers(self) -> Path | None:
        """Return the file of the controllers, if the package has one."""
        end = "_controllers.yaml"
        names = self._names(end)
        if not names:
            LOG.warning("%s has no config/*%s; no controllers are known", self._package_path, end)
            return None
        usual = [name for name in ("moveit", "moveit2", self._robot_name) if name in names]
        if len(names) > 1 and not usual:
            raise RuntimeError(
                f"trajectory_execution: which file of {', '.join(name + end for name in names)} "
                "is not clear; name it as file_path"
            )
        return self._package_path / CONFIG / f"{(usual or names)[0]}{end}"

    def _pipeline(self, name: str, defaults: Mapping[str, Parameters]) -> Parameters:
        """Return the parameters of a planner, of the package's file if it has one."""
        file = self._package_path / CONFIG / f"{name}_planning.yaml"
        if name in defaults and not file.exists():
            return defaults[name]
        content: Parameters = load_yaml(file)
        return content


def described(path: Path, mappings: Mappings | None) -> str | ParameterValue:
    """Return what xacro makes of a description: now, unless its arguments are known at launch."""
    pairs = dict(mappings or {})
    texts = {
        name: value
        for name, value in pairs.items()
        if isinstance(name, str) and isinstance(value, str)
    }
    if len(texts) < len(pairs):
        return ParameterValue(Xacro(str(path), mappings=pairs), value_type=str)
    return load_xacro(path, mappings=texts or None)
