"""A run in ParaView: script writes view.py, which is scene.py with what the run says of itself before it."""
