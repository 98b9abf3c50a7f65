"""The package of cv_bridge's compiled part."""
