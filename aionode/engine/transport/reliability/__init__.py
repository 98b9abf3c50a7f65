"""Reliable delivery over a lossy transport, without I/O: acknowledgements in RTPS terminology.

`StatefulWriter` keeps the messages that its readers have not acknowledged, and has a `ReaderProxy`
for each; `StatefulReader` has a `WriterProxy` for each writer. Their submessages are bytes carried
by a transport: it sends messages to all readers, and submessages to single contexts.
"""
