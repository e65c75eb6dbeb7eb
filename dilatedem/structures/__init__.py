"""What the ice meets: one file a kind of structure, and the record of its loads."""
