"""The case file: its schema, loading, overrides, sweep grids, and writing it back in full."""
