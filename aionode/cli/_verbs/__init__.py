"""What commands do: a coroutine for each verb, with plain arguments."""
