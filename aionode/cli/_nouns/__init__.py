"""The nouns: each command stands with its verb, the coroutine that does its work.

The files of a noun begin with its name.
"""
