"""Read and set the parameters of another node.

Run ``python examples/driver.py``, and in a second terminal ``python examples/parameter_client.py``.
"""

import asyncio

import aionode
from aionode import Node, Parameter
from aionode.parameter_client import AsyncParameterClient


async def main() -> None:
    """Double the speed of the driver."""
    async with Node("tuner") as node:
        driver = AsyncParameterClient(node, "/driver")
        while not await driver.wait_for_services(timeout_sec=1.0):
            node.get_logger().info("Waiting for the node /driver...")

        async with asyncio.timeout(5):
            (speed,) = await driver.get_parameters(["speed"])
            (result,) = await driver.set_parameters([Parameter("speed", value=speed.value * 2)])
        if result.successful:
            node.get_logger().info(f"speed: {speed.value} -> {speed.value * 2}")
        else:
            node.get_logger().error(f"speed is still {speed.value}: {result.reason}")


if __name__ == "__main__":
    aionode.run(main)
