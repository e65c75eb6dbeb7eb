"""Runs of a sweep as ensembles: which part of each is looked at, what is measured there, the laws of the highest loads."""
