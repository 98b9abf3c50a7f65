"""The entities of a node: publishers, subscriptions, services, clients, timers.

They handle typed messages, and use transports only through `aionode.engine.transport.base`.
"""

from aionode._process.sudden_end import mark_sending

mark_sending(__name__)
