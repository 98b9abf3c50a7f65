"""The nouns: each command stands with its verb, the coroutine that does its work.

A noun of several files is a folder, whose first file has the table of its commands.
"""
