"""Ways for messages to travel: `base` is the contract, each other module one implementation."""

from aionode._process.sudden_end import mark_sending

mark_sending(__name__)
