"""Play a bag for Foxglove, whose timeline controls the player.

Run it with ``python examples/gateway/play_bag.py BAG``, and connect Foxglove to
ws://127.0.0.1:9090. It needs ``pip install 'aionode[bag,gateway]'``.
"""

import sys

import aionode
from aionode import Node
from aionode.bag import Player
from aionode.gateway import Gateway, Policy

POLICY = Policy.parse("""
[[who]]
name = "viewer"
loopback = true

[[allow]]
see = "/**"
subscribe = "/**"
call = "/rosbag2_player/*"
""")


async def main(path: str, port: int = 9090) -> None:
    """Play a bag again and again, until Ctrl-C."""
    async with (
        Node("gateway") as node,
        Player(path, loop=True) as player,
        Gateway(node, POLICY, port=port, player=player),
    ):
        await player.play()


if __name__ == "__main__":
    aionode.run(lambda: main(sys.argv[1]))
