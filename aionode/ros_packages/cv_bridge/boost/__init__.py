"""The place of cv_bridge's compiled part."""
