"""The ice field at t = 0: how many floes, what they look like, where they lie."""
