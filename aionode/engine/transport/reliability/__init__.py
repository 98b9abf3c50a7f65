"""Reliable delivery over a lossy transport, without I/O: acknowledgements in the words of RTPS.

`StatefulWriter` keeps the messages that its readers have not acknowledged, and has a `ReaderProxy`
for each; `StatefulReader` has a `WriterProxy` for each writer. Their submessages are bytes that a
transport carries: it puts messages to all readers, and submessages to single contexts.
"""
