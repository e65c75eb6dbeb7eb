"""Loads of a run for the next program: histories at a uniform step, and how they spread over height.

history: windows of forces.csv as samples; heights: load maps as shares; formats: tables that other programs read; folder: which
files of a run become which.
"""
