"""The pictures: a file a subject; canvas is what they are drawn on and written with."""
