"""What a run leaves on disk, and when it is due; observers only: nothing here changes the simulation."""
