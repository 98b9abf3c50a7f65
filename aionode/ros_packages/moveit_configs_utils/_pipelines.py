"""How MoveIt's planners are set up unless a robot's package says otherwise."""

from __future__ import annotations

from copy import deepcopy
from typing import Any, Final

__all__ = ["default_pipelines", "ompl_planner_configs"]

Parameters = dict[str, Any]

REQUEST_ADAPTERS: Final = [
    f"default_planning_request_adapters/{name}"
    for name in (
        *("ResolveConstraintFrames", "ValidateWorkspaceBounds"),
        *("CheckStartStateBounds", "CheckStartStateCollision"),
    )
]
RESPONSE_ADAPTERS: Final = [
    f"default_planning_response_adapters/{name}"
    for name in ("AddTimeOptimalParameterization", "ValidateSolution", "DisplayMotionPath")
]
HUMBLE_ADAPTERS: Final = " ".join(
    f"default_planner_request_adapters/{name}"
    for name in (
        *("AddTimeOptimalParameterization", "ResolveConstraintFrames", "FixWorkspaceBounds"),
        *("FixStartStateBounds", "FixStartStateCollision", "FixStartStatePathConstraints"),
    )
)

PLUGINS: Final = {
    "chomp": "chomp_interface/CHOMPPlanner",
    "ompl": "ompl_interface/OMPLPlanner",
    "pilz_industrial_motion_planner": "pilz_industrial_motion_planner/CommandPlanner",
    "stomp": "stomp_moveit/StompPlanner",
}
"""The plugin of each planner."""
OF_PILZ: Final[Parameters] = {
    "default_planner_config": "PTP",
    "capabilities": "pilz_industrial_motion_planner/MoveGroupSequenceAction "
    "pilz_industrial_motion_planner/MoveGroupSequenceService",
}
OF_STOMP: Final[Parameters] = {
    "stomp_moveit": {
        "num_timesteps": 60,
        "num_iterations": 40,
        "num_iterations_after_valid": 0,
        "num_rollouts": 30,
        "max_rollouts": 30,
        "exponentiated_cost_sensitivity": 0.8,
        "control_cost_weight": 0.1,
        "delta_t": 0.1,
    }
}
PILZ: Final = "pilz_industrial_motion_planner"

RANGE: Final = {"range": 0.0}
BIASED: Final = {**RANGE, "goal_bias": 0.05}
BORDER: Final = {"border_fraction": 0.9}
SPANNER: Final = {
    "stretch_factor": 3.0,
    "sparse_delta_fraction": 0.25,
    "dense_delta_fraction": 0.001,
}
OMPL_PLANNERS: Final[dict[str, Parameters]] = {
    "AnytimePathShortening": {
        "shortcut": 1,
        "hybridize": 1,
        "max_hybrid_paths": 24,
        "num_planners": 4,
        "planners": "",
    },
    "SBL": RANGE,
    "EST": BIASED,
    "LBKPIECE": {**RANGE, **BORDER, "min_valid_path_fraction": 0.5},
    "BKPIECE": {
        **RANGE,
        **BORDER,
        "failed_expansion_score_factor": 0.5,
        "min_valid_path_fraction": 0.5,
    },
    "KPIECE": {
        **BIASED,
        **BORDER,
        "failed_expansion_score_factor": 0.5,
        "min_valid_path_fraction": 0.5,
    },
    "RRT": BIASED,
    "RRTConnect": RANGE,
    "RRTstar": {**BIASED, "delay_collision_checking": 1},
    "TRRT": {
        **BIASED,
        "max_states_failed": 10,
        "temp_change_factor": 2.0,
        "min_temperature": "10e-10",  # YAML 1.1 reads numbers without a point as texts
        "init_temperature": "10e-6",
        "frountier_threshold": 0.0,  # MoveIt's spelling
        "frountierNodeRatio": 0.1,
        "k_constant": 0.0,
    },
    "PRM": {"max_nearest_neighbors": 10},
    "PRMstar": {},
    "FMT": {
        "num_samples": 1000,
        "radius_multiplier": 1.1,
        "nearest_k": 1,
        "cache_cc": 1,
        "heuristics": 0,
        "extended_fmt": 1,
    },
    "BFMT": {
        "num_samples": 1000,
        "radius_multiplier": 1.0,
        "nearest_k": 1,
        "balanced": 0,
        "optimality": 1,
        "heuristics": 1,
        "cache_cc": 1,
        "extended_fmt": 1,
    },
    "PDST": {},
    "STRIDE": {
        **BIASED,
        "use_projected_distance": 0,
        "degree": 16,
        "max_degree": 18,
        "min_degree": 12,
        "max_pts_per_leaf": 6,
        "estimated_dimension": 0.0,
        "min_valid_path_fraction": 0.2,
    },
    "BiTRRT": {
        **RANGE,
        "temp_change_factor": 0.1,
        "init_temperature": 100,
        "frountier_threshold": 0.0,
        "frountier_node_ratio": 0.1,
        "cost_threshold": "1e300",
    },
    "LBTRRT": {**BIASED, "epsilon": 0.4},
    "BiEST": RANGE,
    "ProjEST": BIASED,
    "LazyPRM": RANGE,
    "LazyPRMstar": {},
    "SPARS": {**SPANNER, "max_failures": 1000},
    "SPARStwo": {**SPANNER, "max_failures": 5000},
}
"""The planners of OMPL with their parameters; ``type`` is added to each."""


def default_pipelines(distribution: str) -> dict[str, Parameters]:
    """Return the parameters of each planning pipeline, as MoveIt of a distribution has them."""
    if distribution == "humble":
        return {name: humble(name) for name in PLUGINS if name != "stomp"}
    return {name: deepcopy(current(name)) for name in PLUGINS}


def current(name: str) -> Parameters:
    """Return the parameters of a pipeline since Jazzy."""
    adapters = RESPONSE_ADAPTERS[1:] if name == PILZ else RESPONSE_ADAPTERS
    own: dict[str, Parameters] = {
        "chomp": {"enable_failure_recovery": True, "ridge_factor": 0.01},
        PILZ: OF_PILZ,
        "stomp": OF_STOMP,
    }
    return {
        "planning_plugins": [PLUGINS[name]],
        "request_adapters": REQUEST_ADAPTERS,
        "response_adapters": adapters,
        **own.get(name, {}),
    }


def humble(name: str) -> Parameters:
    """Return the parameters of a pipeline in Humble."""
    plugin = {"planning_plugin": PLUGINS[name]}
    if name == PILZ:
        return {**plugin, "request_adapters": "", **OF_PILZ}
    started = {"start_state_max_bounds_error": 0.1, "jiggle_fraction": 0.05}
    own = {"enable_failure_recovery": True, "ridge_factor": 0.01} if name == "chomp" else {}
    return {**plugin, "request_adapters": HUMBLE_ADAPTERS, **started, **own}


def ompl_planner_configs() -> dict[str, Parameters]:
    """Return the parameters of OMPL's planners."""
    return {
        name: {"type": f"geometric::{name}", **parameters}
        for name, parameters in OMPL_PLANNERS.items()
    }
