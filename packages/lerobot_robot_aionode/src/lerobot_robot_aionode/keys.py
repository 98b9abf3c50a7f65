"""LeRobot's flat keys for the features of a contract."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from aionode.learn import Action, Contract, Observation

__all__ = ["ACTION", "action_keys", "flat", "observation_keys"]

SUFFIXES = (".pos", ".vel")
"""How the keys of numbers end: `lerobot-rollout` leaves out all others."""

STATE = "observation.state"
IMAGES = "observation.images."
ACTION = "action"
CHANNELS = 3


def number_keys(entry: Observation | Action) -> list[str]:
    """Return the keys of an entry's numbers: a unit per second makes a velocity."""
    suffix = ".vel" if entry.unit.endswith("/s") else ".pos"
    return [label if label.endswith(SUFFIXES) else f"{label}{suffix}" for label in entry.labels]


def action_keys(contract: Contract) -> list[str]:
    """Return the key of each number of the actions, in the order of the contract.

    Raises:
        ValueError: two have the same key, or a feature has another name than LeRobot gives it.
    """
    for entry in contract.actions:
        if entry.feature != ACTION:
            raise ValueError(misnamed(entry, ACTION))
    return unique(key for entry in contract.actions for key in number_keys(entry))


def observation_keys(contract: Contract) -> dict[str, Any]:
    """Return what each key of an observation has: a float, or the shape of a picture.

    Raises:
        ValueError: two have the same key, a feature has another name than LeRobot gives it, or is a
            depth picture.
    """
    keys: list[tuple[str, Any]] = []
    for entry in contract.observations:
        if entry.image is None and entry.feature != STATE:
            raise ValueError(misnamed(entry, STATE))
        if entry.image and not entry.feature.startswith(IMAGES):
            raise ValueError(misnamed(entry, f"{IMAGES}NAME"))
        if entry.image == "depth":
            raise ValueError(
                f"{entry.topic}: depth pictures are not passed on to LeRobot's loops; leave the "
                "feature out of the contract for them"
            )
        if entry.image is None:
            keys += [(key, float) for key in number_keys(entry)]
        else:
            keys.append((entry.feature.removeprefix(IMAGES), (*entry.shape[:2], CHANNELS)))
    unique(key for key, _ in keys)
    return dict(keys)


def flat(contract: Contract, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return what LeRobot calls an observation."""
    found: dict[str, Any] = {}
    for name, value in values.items():
        feature = contract.features[name]
        if feature.kind == "numbers":
            keys = [key for entry in feature.entries for key in number_keys(entry)]
            found |= zip(keys, map(float, value), strict=True)
        elif feature.kind == "mono":
            found[name.removeprefix(IMAGES)] = np.repeat(value[..., np.newaxis], CHANNELS, axis=2)
        else:
            found[name.removeprefix(IMAGES)] = np.array(value)  # the message's own may not change
    return found


def misnamed(entry: Observation | Action, name: str) -> str:
    """Return what is wrong with a feature that LeRobot's loops would rename without a word."""
    return (
        f"{entry.feature}: LeRobot's loops call it {name}, so that a policy trained on an export "
        "would not find it; name the feature so in the contract, and export again"
    )


def unique(keys: Iterable[str]) -> list[str]:
    """Return keys as a list; ValueError if one occurs twice."""
    found = list(keys)
    twice = sorted({key for key in found if found.count(key) > 1})
    if twice:
        raise ValueError(
            f"contract: {', '.join(twice)} occurs twice; LeRobot has one name for each number of "
            "all topics: give each its own by `names`"
        )
    return found
