"""Files on disk, whatever they hold: written as a whole, in folders that are locked, over nothing that somebody else made."""
