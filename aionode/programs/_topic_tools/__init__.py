"""``topic_tools``: programs that republish topics of any type."""
