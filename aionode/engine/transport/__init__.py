"""Ways to transport messages: `base` is the contract, the other modules implement it."""

from aionode._process.sudden_end import mark_sending

mark_sending(__name__)
