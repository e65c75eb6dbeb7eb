"""What changes which bodies there are, between two steps: one file an event; `repack` is the door for all of them."""
