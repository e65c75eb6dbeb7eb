"""How fast the program is: fixed scenes, sizes, threads and contact models, timed; `python -m benchmarks --help`."""
