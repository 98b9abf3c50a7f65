"""The entities of a node: publishers, subscriptions, services, clients, timers.

They handle typed messages, and reach transports only through `aionode.transport.base`.
"""

from aionode._process.sudden_end import mark_sending

mark_sending(__name__)
