"""Maps of Nav2: files with pictures of them, and the node that publishes one."""
