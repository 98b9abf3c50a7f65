"""unique_identifier_msgs."""
