"""The entities of a node: publishers, subscriptions, services, clients, timers.

They hold typed messages and know their transport only through `aionode.transport.base`.
"""
