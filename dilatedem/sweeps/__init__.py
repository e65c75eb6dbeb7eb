"""A grid of cases: planned and checked, run side by side on this machine or on a cluster, told in one table."""
