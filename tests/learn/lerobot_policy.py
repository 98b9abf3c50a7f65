"""A mock policy, as `lerobot-rollout` loads it: it moves the joint to 0.5 rad.

Its configuration, model and processors are found in this module by LeRobot's naming convention.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import torch
from lerobot.configs import FeatureType, NormalizationMode, PolicyFeature, PreTrainedConfig
from lerobot.policies.pretrained import PreTrainedPolicy
from lerobot.processor.factory import make_default_pre_post_processors

__all__ = ["TARGET", "MockConfig", "MockPolicy", "make_mock_pre_post_processors", "save"]

TARGET = 0.5


@PreTrainedConfig.register_subclass("mock")
@dataclass
class MockConfig(PreTrainedConfig):  # type: ignore[misc]  # LeRobot is not there
    """The features that the policy sees and commands."""

    observation_delta_indices = None
    action_delta_indices = None
    reward_delta_indices = None

    def get_optimizer_preset(self) -> Any:
        """Refuse to be trained."""
        raise NotImplementedError

    def get_scheduler_preset(self) -> None:
        """Have none."""

    def validate_features(self) -> None:
        """Have nothing to check."""


class MockPolicy(PreTrainedPolicy):  # type: ignore[misc]  # LeRobot is not there
    """Goes a tenth of the way to its target in each step, if it sees a picture."""

    config_class = MockConfig
    name = "mock"

    def __init__(self, config: MockConfig, **_: Any) -> None:
        super().__init__(config)
        self.target = torch.nn.Parameter(torch.tensor([TARGET]))

    def get_optim_params(self) -> Any:
        """Return its parameters."""
        return self.parameters()

    def reset(self) -> None:
        """Have no state."""

    def forward(self, batch: Any) -> Any:
        """Refuse to be trained."""
        raise NotImplementedError

    def predict_action_chunk(self, batch: Any, **_: Any) -> Any:
        """Return a chunk of one action."""
        return self.select_action(batch)[:, None]

    def select_action(self, batch: Any, **_: Any) -> Any:
        """Return the next action."""
        state, picture = batch["observation.state"], batch["observation.images.front"]
        assert picture.shape[1] == 3
        assert picture.max() > 0.5, "the marker is not there"
        return state + (self.target - state) / 10


def make_mock_pre_post_processors(config: MockConfig, **options: Any) -> Any:
    """Return the default processors."""
    return make_default_pre_post_processors(config, options.get("dataset_stats"))


def save(folder: Any, height: int, width: int) -> None:
    """Save the policy as a training would."""
    config = MockConfig(
        device="cpu",
        input_features={
            "observation.state": PolicyFeature(FeatureType.STATE, (1,)),
            "observation.images.front": PolicyFeature(FeatureType.VISUAL, (3, height, width)),
        },
        output_features={"action": PolicyFeature(FeatureType.ACTION, (1,))},
    )
    config.normalization_mapping = dict.fromkeys(
        ("STATE", "VISUAL", "ACTION"), NormalizationMode.IDENTITY
    )
    MockPolicy(config).save_pretrained(folder)
    for processor in make_mock_pre_post_processors(config):
        processor.save_pretrained(folder)
