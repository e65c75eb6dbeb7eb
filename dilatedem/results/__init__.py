"""Reading what a run or a sweep left behind: tables as pandas DataFrames, load maps as xarray Datasets, floes, snapshots.

`dilatedem.load(folder)` is the door. Nothing here knows the simulation; a folder of another machine, of a run that is still
under way or of one that was killed is read as far as it goes. `post` reads through these modules, too.
"""
