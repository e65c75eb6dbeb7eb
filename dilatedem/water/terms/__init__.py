"""Loads on a floating body, one file a term. A new term is a file beside these, and its `TERM` in `water.loads.TERMS`."""
