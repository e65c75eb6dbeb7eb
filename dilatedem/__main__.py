"""`python -m dilatedem`: the command line."""

from dilatedem.cli import main

main()
