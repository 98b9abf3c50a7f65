"""The nouns: each command next to its verb, the coroutine that does its work.

A noun that needs several files is a package whose ``__init__`` lists its commands.
"""
