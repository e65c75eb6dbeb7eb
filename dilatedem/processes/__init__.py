"""Processes and signals: Ctrl-C, the children of a sweep, and what becomes of them when their parent is gone."""
